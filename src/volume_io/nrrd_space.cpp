#include "volume_io/nrrd_space.h"

#include <fmt/format.h>

#include <charconv>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/fail.h"
#include "volume_io/geometry_check.h"

namespace voxlume {
namespace {

/// The vectors of three numbers in "(1,0,0) (0,1,0)"; none when something else stands there.
std::optional<std::vector<std::array<double, 3>>> parse_vectors(const std::string& text) {
  std::vector<std::array<double, 3>> vectors;
  const char* at = text.data();
  const char* end = text.data() + text.size();
  const auto skip = [&](char c) {
    while (at != end && *at == ' ') ++at;
    const bool found = at != end && *at == c;
    at += found;
    while (at != end && (*at == ' ' || *at == '+')) ++at;
    return found;
  };
  while (skip('(')) {
    std::array<double, 3> vector{};
    for (int r = 0; r < 3; ++r) {
      if (r > 0 && !skip(',')) return std::nullopt;
      const auto [next, error] = std::from_chars(at, end, vector[r]);
      if (error != std::errc()) return std::nullopt;
      at = next;
    }
    if (!skip(')')) return std::nullopt;
    vectors.push_back(vector);
  }
  if (at != end) return std::nullopt;
  return vectors;
}

void turn_from_las(const std::filesystem::path& path, const NrrdFields& fields, Volume& volume) {
  const auto axes = parse_vectors(fields.value("spacedirections"));
  const auto origin = parse_vectors(fields.value("spaceorigin"));
  if (!axes || axes->size() != 3 || !origin || origin->size() > 1) {
    fail(ErrorCode::kUnsupported, path,
         "left-anterior-superior space without three axis vectors and an origin");
  }
  std::array<double, 9> mm_per_voxel{};
  for (int a = 0; a < 3; ++a) {
    mm_per_voxel[a] = (*axes)[a][0];
    mm_per_voxel[3 + a] = -(*axes)[a][1] + 0.0;
    mm_per_voxel[6 + a] = (*axes)[a][2];
  }
  set_axes(volume, mm_per_voxel);
  if (!origin->empty()) volume.origin_mm = {(*origin)[0][0], -(*origin)[0][1] + 0.0, (*origin)[0][2]};
}

/// Millimetres of the unit in which lengths are given, when all axes name the same one.
std::optional<double> unit_mm(const std::string& units) {
  const std::map<std::string, double> kUnits = {{"mm", 1},         {"cm", 10},          {"m", 1000},
                                                {"um", 1e-3},      {"\xc2\xb5m", 1e-3}, {"\xce\xbcm", 1e-3},
                                                {"microns", 1e-3}, {"nm", 1e-6}};
  std::optional<double> mm;
  std::size_t at = 0;
  while ((at = units.find('"', at)) != std::string::npos) {
    const std::size_t end = units.find('"', at + 1);
    if (end == std::string::npos) return std::nullopt;
    const auto unit = kUnits.find(units.substr(at + 1, end - at - 1));
    if (unit == kUnits.end() || (mm && *mm != unit->second)) return std::nullopt;
    mm = unit->second;
    at = end + 1;
  }
  return mm;
}

}  // namespace

void complete_nrrd_space(const std::filesystem::path& path, const NrrdFields& fields, Volume& volume) {
  const std::string space = fields.value("space");
  const bool is_las = space == "left-anterior-superior" || space == "LAS";
  const bool is_anatomical = is_las || space == "right-anterior-superior" || space == "RAS" ||
                             space == "left-posterior-superior" || space == "LPS";
  if (is_las) turn_from_las(path, fields, volume);
  if (!space.empty() && !is_anatomical) {
    volume.warnings.push_back(fmt::format(
        "the NRRD space \"{}\" has no patient directions; it is taken for left-posterior-superior",
        one_line(space.substr(0, 40))));
  }
  const std::string space_units = fields.value("spaceunits");
  const double mm = unit_mm(space_units.empty() ? fields.value("units") : space_units).value_or(1);
  for (int a = 0; a < 3; ++a) {
    volume.spacing_mm[a] *= mm;
    volume.origin_mm[a] *= mm;
  }
}

}  // namespace voxlume
