#pragma once
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>

#include "server/messages.h"
#include "server/opening.h"
#include "voxlume/error.h"

namespace voxlume::server {

// What the server says, as JSON (docs/viewer-protocol.md).

/// `status`; a name, message or share that there is none of is left out.
nlohmann::json status_json(const OpeningStatus& status);
/// `progress` [s, samples per second].
nlohmann::json progress_json(const RenderProgress& progress);
/// `split`, at a share of the width in [0, 1]; absent: none.
nlohmann::json split_json(const std::optional<double>& at);
/// `preset_drawn`.
nlohmann::json preset_drawn_json(const std::string& preset);

/// What a page is told whose message `text` could not be followed; `message` is absent where it could not be
/// read.
nlohmann::json failure_json(const std::optional<PageMessage>& message, std::string_view text,
                            const Error& error);

}  // namespace voxlume::server
