#include "server/zip_file.h"

#include <archive.h>
#include <archive_entry.h>

#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "base/fail.h"

namespace voxlume::server {

namespace fs = std::filesystem;

namespace {

using Archive = std::unique_ptr<archive, int (*)(archive*)>;

void check(int result, const Archive& zip, const fs::path& path) {
  if (result < ARCHIVE_WARN) fail(ErrorCode::kInternal, path, archive_error_string(zip.get()));
}

void add(const fs::path& file, const Archive& zip, const fs::path& path) {
  const std::unique_ptr<archive_entry, void (*)(archive_entry*)> entry(archive_entry_new(),
                                                                       archive_entry_free);
  archive_entry_set_pathname(entry.get(), file.filename().c_str());
  archive_entry_set_size(entry.get(), static_cast<la_int64_t>(fs::file_size(file)));
  archive_entry_set_filetype(entry.get(), AE_IFREG);
  archive_entry_set_perm(entry.get(), 0644);
  check(archive_write_header(zip.get(), entry.get()), zip, path);
  std::ifstream in(file, std::ios::binary);
  std::vector<char> block(1 << 16);
  while (in.read(block.data(), static_cast<std::streamsize>(block.size())), in.gcount() > 0) {
    const auto count = static_cast<std::size_t>(in.gcount());
    if (archive_write_data(zip.get(), block.data(), count) < 0) check(ARCHIVE_FATAL, zip, path);
  }
}

}  // namespace

void write_zip(const std::vector<fs::path>& files, const fs::path& path) {
  const Archive zip(archive_write_new(), archive_write_free);
  if (!zip) fail(ErrorCode::kInternal, path, "cannot be written");
  check(archive_write_set_format_zip(zip.get()), zip, path);
  check(archive_write_zip_set_compression_store(zip.get()), zip, path);
  check(archive_write_open_filename(zip.get(), path.c_str()), zip, path);
  for (const fs::path& file : files) add(file, zip, path);
  check(archive_write_close(zip.get()), zip, path);
}

}  // namespace voxlume::server
