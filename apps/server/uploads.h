#pragma once
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "voxlume/scene.h"

namespace voxlume::server {

/// Files that belong together, such as the slices of a series: they lie in one folder.
struct UploadSet {
  std::string id;      ///< chosen by the page, another one for every set
  std::string folder;  ///< the name of their folder
};

/// Files that pages sent, together no larger than a limit. What is there is never changed or replaced, as it
/// may be open: of two files of one name the second lies in another folder.
class Uploads {
 public:
  /// A file on its way; what it took is given back unless it is finished, and its set with it. May outlive
  /// the uploads, then without finish().
  class Incoming {
   public:
    Incoming(Uploads& uploads, std::string name, std::string set);
    ~Incoming();
    Incoming(const Incoming&) = delete;
    Incoming& operator=(const Incoming&) = delete;

    /// Where the bytes go until all are there.
    const std::filesystem::path& path() const { return path_; }
    /// Puts the whole file in place. Returns what is to be opened: the file, of a set its folder. Throws
    /// Error kBadParameter where the set has a file of that name, kInternal.
    std::filesystem::path finish();

   private:
    const std::weak_ptr<Uploads*> uploads_;
    const std::string name_, set_;
    std::filesystem::path path_;
    bool finished_ = false;
  };

  Uploads(std::filesystem::path folder, std::uint64_t most_bytes, std::size_t most_files_of_set = 20000);

  /// Bytes that one more may have: of the limit what is left, and of the disk.
  std::uint64_t room() const;
  /// Throws Error: kBadParameter where `name`, or a name of the set, is not the plain name of a file,
  /// kUnsupported where the set has too many files.
  std::unique_ptr<Incoming> begin(const std::string& name,
                                  const std::optional<UploadSet>& set = std::nullopt);

  /// What `path` is opened as: of uploads their main_file(), of all others itself. No further file may come
  /// to a set. Throws Error, those of main_file(); then the set is gone.
  std::filesystem::path opened_as(const std::filesystem::path& path);
  /// The newest file or folder of that name, of sets that were opened; empty where there is none.
  std::filesystem::path find(const std::string& name) const;

  /// Calls what was uploaded by its name alone in the scene, and returns these names: whoever reads the scene
  /// elsewhere puts these files beside it. Throws Error kBadParameter where two files have the same name.
  std::set<std::string> name_uploads(SceneDescription& scene) const;

 private:
  struct Set {
    std::filesystem::path folder;
    std::size_t files = 0;
    std::uint64_t bytes = 0;
  };

  bool contains(const std::filesystem::path& path) const;
  std::filesystem::path new_folder();
  Set& set_of(const UploadSet& named);
  void drop(std::string set);

  const std::filesystem::path folder_;
  const std::uint64_t most_bytes_;
  const std::size_t most_files_of_set_;
  std::uint64_t count_ = 0, used_bytes_ = 0;
  std::set<const Incoming*> incoming_;
  const std::shared_ptr<Uploads*> self_ = std::make_shared<Uploads*>(this);
  std::map<std::string, Set> sets_;                      ///< by id; those that are not complete
  std::map<std::string, std::filesystem::path> newest_;  ///< by name
};

/// Whether a name may be a file's: text without slashes and control characters that does not begin with a
/// dot.
bool is_plain_file_name(const std::string& name);

}  // namespace voxlume::server
