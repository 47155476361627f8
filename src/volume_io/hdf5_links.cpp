#include "volume_io/hdf5_links.h"

#include <hdf5.h>

#include "base/fail.h"

namespace voxlume {
namespace {

/// An identifier of the library's, closed at the end.
class Hdf5Id {
 public:
  Hdf5Id(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Hdf5Id() {
    if (id_ >= 0) close_(id_);
  }
  Hdf5Id(const Hdf5Id&) = delete;
  Hdf5Id& operator=(const Hdf5Id&) = delete;
  hid_t get() const { return id_; }
  bool is_open() const { return id_ >= 0; }

 private:
  const hid_t id_;
  herr_t (*const close_)(hid_t);
};

/// What a walk over all links returns: what the library gives back as the walk's own result.
constexpr herr_t kGoOn = 0, kLeadsOutside = 1, kDamaged = -1;

bool is_stored_elsewhere(hid_t dataset) {
  const Hdf5Id properties(H5Dget_create_plist(dataset), H5Pclose);
  return H5Pget_external_count(properties.get()) != 0 || H5Pget_layout(properties.get()) == H5D_VIRTUAL;
}

// Links that are soft lead to others of the same file, which are come past by themselves.
herr_t look_at_link(hid_t group, const char* name, const H5L_info_t* link, void*) {
  if (link->type == H5L_TYPE_SOFT) return kGoOn;
  if (link->type != H5L_TYPE_HARD) return kLeadsOutside;
  const Hdf5Id object(H5Oopen(group, name, H5P_DEFAULT), H5Oclose);
  if (!object.is_open()) return kDamaged;
  return H5Iget_type(object.get()) == H5I_DATASET && is_stored_elsewhere(object.get()) ? kLeadsOutside
                                                                                       : kGoOn;
}

}  // namespace

void check_hdf5_is_one_file(const std::filesystem::path& path) {
  herr_t found = kGoOn;
  H5E_BEGIN_TRY {  // without a word on the terminal
    const Hdf5Id file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
    if (file.is_open()) found = H5Lvisit(file.get(), H5_INDEX_NAME, H5_ITER_NATIVE, look_at_link, nullptr);
  }
  H5E_END_TRY;
  if (found > 0)
    fail(ErrorCode::kUnsupported, path,
         "has links to other files or data in them; expected an HDF5 file that holds everything itself");
  if (found < 0)
    fail(ErrorCode::kBadFormat, path, "this HDF5 file is damaged: an object in it cannot be read");
}

}  // namespace voxlume
