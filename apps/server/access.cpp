#include "server/access.h"

#include <unistd.h>

#include <algorithm>
#include <boost/asio/ip/address.hpp>
#include <random>

namespace voxlume::server {
namespace {

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; }

bool equal_without_case(std::string_view a, std::string_view b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](char x, char y) { return lower(x) == lower(y); });
}

std::string_view trimmed(std::string_view text) {
  while (!text.empty() && text.front() == ' ') text.remove_prefix(1);
  while (!text.empty() && text.back() == ' ') text.remove_suffix(1);
  return text;
}

/// "name", "name:80", "[::1]:80" without the port, and the brackets; empty where it is no such thing.
std::string_view host_name(std::string_view header) {
  std::string_view port;
  std::string_view name = header;
  if (header.starts_with('[')) {
    const std::size_t end = header.find(']');
    if (end == std::string_view::npos) return {};
    name = header.substr(1, end - 1);
    port = header.substr(end + 1);
  } else if (const std::size_t colon = header.find(':'); colon != std::string_view::npos) {
    name = header.substr(0, colon);
    port = header.substr(colon);
  }
  if (port.empty()) return name;
  const std::string_view digits = port.substr(1);
  const bool is_port = port[0] == ':' && !digits.empty() && digits.size() <= 5 &&
                       digits.find_first_not_of("0123456789") == std::string_view::npos;
  return is_port ? name : std::string_view{};
}

std::string machine_name() {
  char name[256] = "";
  return ::gethostname(name, sizeof name - 1) == 0 ? name : "";
}

}  // namespace

std::string make_token() {
  std::random_device source;  // the system's own, which cannot be guessed
  std::string token;
  for (int word = 0; word < 4; ++word) {
    const unsigned bits = source();
    for (int shift = 28; shift >= 0; shift -= 4) token += "0123456789abcdef"[bits >> shift & 15];
  }
  return token;
}

bool equal_in_constant_time(std::string_view a, std::string_view b) {
  unsigned difference = a.size() == b.size() ? 0 : 1;
  for (std::size_t i = 0; i < b.size(); ++i)
    difference |= static_cast<unsigned char>(a.empty() ? '\0' : a[i % a.size()]) ^
                  static_cast<unsigned>(static_cast<unsigned char>(b[i]));
  return difference == 0;
}

std::string_view cookie_value(std::string_view header, std::string_view name) {
  while (!header.empty()) {
    const std::size_t end = std::min(header.find(';'), header.size());
    const std::string_view pair = trimmed(header.substr(0, end));
    header.remove_prefix(std::min(end + 1, header.size()));
    const std::size_t equals = pair.find('=');
    if (equals != std::string_view::npos && pair.substr(0, equals) == name) return pair.substr(equals + 1);
  }
  return {};
}

Access::Access(std::string token, std::string bound_to, unsigned short port)
    : token_(std::move(token)),
      bound_to_(std::move(bound_to)),
      cookie_name_("voxlume_" + std::to_string(port)) {}

std::string Access::set_cookie() const {
  return cookie_name_ + "=" + token_ + "; Path=/; HttpOnly; SameSite=Lax";
}

bool Access::is_host(std::string_view host_header) const {
  const std::string_view name = host_name(host_header);
  if (name.empty()) return false;
  if (equal_without_case(name, "localhost") || equal_without_case(name, bound_to_)) return true;
  boost::system::error_code failed;
  const auto bound = boost::asio::ip::make_address(bound_to_, failed);
  if (failed || !bound.is_unspecified()) return false;
  // A name would let any page reach the server that points its own name here; an address does not.
  boost::asio::ip::make_address(std::string(name), failed);
  return !failed || equal_without_case(name, machine_name());
}

bool is_same_origin(std::string_view origin, std::string_view host_header) {
  for (const std::string_view scheme : {"http://", "https://"})
    if (origin.starts_with(scheme))
      return !host_header.empty() && equal_without_case(origin.substr(scheme.size()), host_header);
  return false;
}

bool may_ask(std::string_view sec_fetch_site, std::string_view path) {
  const bool of_other = sec_fetch_site == "cross-site" || sec_fetch_site == "same-site";
  return !of_other || path == "/";
}

bool is_loopback(std::string_view address) {
  boost::system::error_code failed;
  const auto parsed = boost::asio::ip::make_address(std::string(address), failed);
  return !failed && parsed.is_loopback();
}

}  // namespace voxlume::server
