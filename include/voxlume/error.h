#pragma once
#include <stdexcept>
#include <string>

namespace voxlume {

enum class ErrorCode {
  kFileNotFound,  ///< nothing there, or not readable
  kBadFormat,     ///< the bytes are not what their format promises
  kUnsupported,   ///< understood, and not done by voxlume
  kBadParameter,  ///< a value the caller chose is out of its range
  kOutOfMemory,   ///< the estimate exceeds what the machine has
  kInternal,      ///< a defect of voxlume or of the machine (disk full, ...)
};

/// The one error type of the library. Thrown only by cold code: reading, parsing, compiling, writing.
/// what() is one line, "where: message"; the message says what was found and what was expected.
class Error : public std::runtime_error {
 public:
  /// `where`: a file name, "file: byte N", or "scene.json: /transfer/points/3". May be empty.
  Error(ErrorCode code, const std::string& where, const std::string& message)
      : std::runtime_error(where.empty() ? message : where + ": " + message),
        code_(code),
        where_(where),
        message_(message) {}

  ErrorCode code() const noexcept { return code_; }
  const std::string& where() const noexcept { return where_; }
  const std::string& message() const noexcept { return message_; }

 private:
  ErrorCode code_;
  std::string where_;
  std::string message_;
};

}  // namespace voxlume
