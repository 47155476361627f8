#pragma once
#include <string>
#include <string_view>

namespace voxlume::server {

/// 128 random bits in hexadecimal. Whoever has it may use the server.
std::string make_token();

/// Whether the texts are equal, in a time that does not tell where they differ.
bool equal_in_constant_time(std::string_view a, std::string_view b);

/// The value of a cookie in a request's Cookie header; empty where it is not there.
std::string_view cookie_value(std::string_view header, std::string_view name);

/// Whom the server answers.
class Access {
 public:
  /// `bound_to` is the address listened at ("127.0.0.1", "::1", "0.0.0.0").
  Access(std::string token, std::string bound_to, unsigned short port);

  const std::string& token() const { return token_; }
  const std::string& address() const { return bound_to_; }
  const std::string& cookie_name() const { return cookie_name_; }
  /// The header that makes a browser keep the token. Of requests that other sites' pages make, the browser
  /// sends it with links that are followed alone.
  std::string set_cookie() const;

  bool is_token(std::string_view text) const { return equal_in_constant_time(text, token_); }
  bool has_cookie(std::string_view cookie_header) const {
    return is_token(cookie_value(cookie_header, cookie_name_));
  }
  /// Whether a request's Host header names this server: the address bound to or localhost, with any port, as
  /// a tunnel may have another. A server bound to every address answers to any address, and to its own name.
  bool is_host(std::string_view host_header) const;

 private:
  std::string token_, bound_to_, cookie_name_;
};

/// Whether the page at `origin` is the one that `host_header` names: the same host and port.
bool is_same_origin(std::string_view origin, std::string_view host_header);

/// Whether a page of this server asks for `path`, or somebody followed a link to the page. `sec_fetch_site`
/// is the browser's word on who asks; empty where it says nothing.
bool may_ask(std::string_view sec_fetch_site, std::string_view path);

/// Whether nobody but this machine reaches the address.
bool is_loopback(std::string_view address);

}  // namespace voxlume::server
