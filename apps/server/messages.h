#pragma once
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "base/vec.h"
#include "server/document.h"

namespace voxlume::server {

// What pages say (docs/viewer-protocol.md).

struct EditMessage {
  std::int64_t seq = 0;
  std::vector<FieldEdit> set;
  std::string gesture;
};
struct PassingMessage {
  std::int64_t seq = 0;
  std::vector<FieldEdit> set;
};
struct UndoMessage {};
struct RedoMessage {};
struct LoadMessage {
  nlohmann::json scene;
};
struct OpenMessage {
  std::string path;
};
struct CancelOpenMessage {};
struct SplitMessage {
  std::optional<double> at;  ///< [0, 1]
};
struct SeekMessage {
  std::optional<double> time_s;
};
struct ProbeMessage {
  std::int64_t id = 0;
  double x = 0, y = 0;                 ///< [0, 1] from the picture's top left
  std::optional<Vec3d> position_mm{};  ///< LPS, in place of x and y
};
struct ExportMessage {
  std::string file;
};
struct CancelExportMessage {};
struct DrawPresetsMessage {};
struct ShownMessage {
  std::uint64_t frame = 0;
};

using PageMessage = std::variant<EditMessage, PassingMessage, UndoMessage, RedoMessage, LoadMessage,
                                 OpenMessage, CancelOpenMessage, SplitMessage, SeekMessage, ProbeMessage,
                                 ExportMessage, CancelExportMessage, DrawPresetsMessage, ShownMessage>;

/// Reads a text frame. Throws Error: kBadFormat where it is no JSON object of bounded depth, kBadParameter
/// where a member is missing or wrong; where() is the member ("/set/0/0"). A member that is not known is
/// passed over.
PageMessage parse_message(std::string_view text);

/// The `seq` of an edit that could not be read, where it has one.
std::optional<std::int64_t> seq_of(std::string_view text);

/// JSON as text; bytes that are not UTF-8 (file names) are replaced.
std::string text_of(const nlohmann::json& message);

}  // namespace voxlume::server
