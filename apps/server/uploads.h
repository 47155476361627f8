#pragma once
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

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
    /// The id of its set; empty: it stands alone.
    const std::string& set() const { return set_; }
    /// It will have so many bytes at most; they are taken from the room of others.
    void reserve(std::uint64_t bytes) { reserved_bytes_ = bytes; }
    std::uint64_t reserved_bytes() const { return reserved_bytes_; }
    /// Puts the whole file in place. Returns what is to be opened: the file, of a set its folder. Throws
    /// Error kBadParameter where the set has a file of that name, kInternal.
    std::filesystem::path finish();

   private:
    const std::weak_ptr<Uploads*> uploads_;
    const std::string name_, set_;
    std::filesystem::path path_;
    std::uint64_t reserved_bytes_ = 0;
    bool finished_ = false;
  };

  struct Limits {
    std::uint64_t most_bytes = 0;  ///< of all together
    std::size_t most_files_of_set = 20000;
    /// A set that nobody goes on with, nor opens, is given up after so long.
    std::chrono::steady_clock::duration patience = std::chrono::minutes(10);
  };

  Uploads(std::filesystem::path folder, const Limits& limits);

  /// Bytes that one more may have: of the limit what is left, and of the disk.
  std::uint64_t room() const;
  /// Throws Error: kBadParameter where `name`, or a name of the set, is not the plain name of a file, or the
  /// set is complete or gone; kUnsupported where it has too many files. What is refused takes its set with
  /// it.
  std::unique_ptr<Incoming> begin(const std::string& name,
                                  const std::optional<UploadSet>& set = std::nullopt);

  /// What `path` is opened as: of uploads their main_file(), of all others itself. No further file may come
  /// to a set. Throws Error, those of main_file(); then it is given up.
  std::filesystem::path opened_as(const std::filesystem::path& path);
  /// What is at `path`, with its set, is in use and stays.
  void keep(const std::filesystem::path& path);
  /// What is at `path` could not be opened: unless it was kept before, it is gone, with its set. All paths
  /// but those of uploads are passed over.
  void give_up(const std::filesystem::path& path);
  /// The newest file or folder of that name, of sets that were opened; empty where there is none.
  std::filesystem::path find(const std::string& name) const;

  /// The text with paths of uploads cut down to their names, as those who sent them know them. Any thread.
  std::string with_names_alone(std::string text) const;

  /// Calls what was uploaded by its name alone in the scene, and returns these names: whoever reads the scene
  /// elsewhere puts these files beside it. Throws Error kBadParameter where two files have the same name.
  std::set<std::string> name_uploads(SceneDescription& scene) const;

 private:
  using Clock = std::chrono::steady_clock;
  /// Files that may still get more.
  struct Set {
    std::filesystem::path folder;
    std::size_t files = 0;
    std::uint64_t bytes = 0;
    Clock::time_point touched{};
  };
  /// A file, or a set that is complete.
  struct Whole {
    std::uint64_t bytes = 0;
    bool kept = false;
  };

  bool contains(const std::filesystem::path& path) const;
  std::filesystem::path new_folder();
  /// The folder of new_folder() that a path of uploads is in.
  std::filesystem::path folder_of(const std::filesystem::path& path) const;
  Set& set_of(const UploadSet& named);
  void drop(std::string set);
  void drop_abandoned();
  void remove(const std::filesystem::path& folder, std::uint64_t bytes);

  const std::filesystem::path folder_;
  const Limits limits_;
  std::uint64_t count_ = 0, used_bytes_ = 0;
  std::set<const Incoming*> incoming_;
  const std::shared_ptr<Uploads*> self_ = std::make_shared<Uploads*>(this);
  std::map<std::string, Set> sets_;               ///< by id; those that are not complete
  std::set<std::string> ended_;                   ///< ids of sets that are complete or gone
  std::map<std::filesystem::path, Whole> whole_;  ///< by the folder of new_folder()
  std::map<std::string, std::vector<std::filesystem::path>> named_;  ///< by name, the newest last
};

/// Whether a name may be a file's: text without slashes and control characters that does not begin with a
/// dot.
bool is_plain_file_name(const std::string& name);

}  // namespace voxlume::server
