#include "server/header_files.h"

#include <algorithm>
#include <fstream>

namespace voxlume::server {
namespace {

constexpr std::size_t kMostHeaderBytes = std::size_t{1} << 20;

std::string trimmed(const std::string& text) {
  const char* const kBlanks = " \t\r\"";
  const std::size_t start = text.find_first_not_of(kBlanks);
  return start == std::string::npos ? "" : text.substr(start, text.find_last_not_of(kBlanks) - start + 1);
}

/// "Data File" is "datafile".
std::string plain_key(const std::string& text) {
  std::string key;
  for (const char c : text)
    if (c != ' ' && c != '\t') key += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  return key;
}

}  // namespace

std::vector<std::filesystem::path> links_in_folder(const std::filesystem::path& folder) {
  std::vector<std::filesystem::path> out;
  std::error_code failed;
  for (auto it = std::filesystem::directory_iterator(folder, failed);
       !failed && it != std::filesystem::directory_iterator(); it.increment(failed)) {
    std::error_code broken;
    if (it->is_symlink(broken) && it->is_regular_file(broken)) out.push_back(it->path());
  }
  return out;
}

std::vector<std::string> files_named_in_header(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::string text(kMostHeaderBytes, '\0');
  file.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(file.gcount()));
  std::vector<std::string> names;
  bool listing = false;  // names stand on lines of their own
  for (std::size_t start = 0; start < text.size();) {
    const std::size_t end = std::min(text.find('\n', start), text.size());
    const std::string line = text.substr(start, std::min<std::size_t>(end - start, 8192));
    start = end + 1;
    if (listing && !trimmed(line).empty()) names.push_back(trimmed(line));
    const std::size_t sign = line.find_first_of(":=");
    if (sign == std::string::npos) continue;
    const std::string key = plain_key(line.substr(0, sign));
    if (key != "datafile" && key != "elementdatafile") continue;
    const std::string name = trimmed(line.substr(std::min(sign + 1, line.size())));
    listing = listing || name.starts_with("LIST");
    if (name != "LOCAL" && !name.starts_with("LIST")) names.push_back(name);
  }
  return names;
}

}  // namespace voxlume::server
