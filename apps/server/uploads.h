#pragma once
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace voxlume::server {

/// Files that pages sent, together no larger than a limit. What is there is never changed or replaced, as it
/// may be open: of two files of one name the second lies in another folder.
class Uploads {
 public:
  /// A file on its way; what it took is given back unless it is finished.
  class Incoming {
   public:
    Incoming(Uploads& uploads, std::string name, std::uint64_t number);
    ~Incoming();
    Incoming(const Incoming&) = delete;
    Incoming& operator=(const Incoming&) = delete;

    /// Where the bytes go until all are there.
    const std::filesystem::path& path() const { return path_; }
    /// Puts the whole file in place. Throws Error kInternal.
    std::filesystem::path finish();

   private:
    Uploads& uploads_;
    const std::string name_;
    std::filesystem::path path_;
  };

  Uploads(std::filesystem::path folder, std::uint64_t most_bytes);

  /// Bytes that one more may have: of the limit what is left, and of the disk.
  std::uint64_t room() const;
  /// Throws Error kBadParameter where `name` is not the plain name of a file.
  std::unique_ptr<Incoming> begin(const std::string& name);

 private:
  const std::filesystem::path folder_;
  const std::uint64_t most_bytes_;
  std::uint64_t count_ = 0;
};

/// Whether a name may be a file's: text without slashes and control characters that does not begin with a
/// dot.
bool is_plain_file_name(const std::string& name);

}  // namespace voxlume::server
