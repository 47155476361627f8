#pragma once
#include <filesystem>
#include <string>
#include <vector>

namespace voxlume::test {

/// What a run of the program left behind.
struct RunResult {
  int code = -1;  ///< exit code; 128 + the signal that ended it
  std::string out, err;
};

/// A run of the program under way.
class Process {
 public:
  /// Starts VOXLUME_BINARY in `folder`. Its standard input is empty.
  Process(const std::vector<std::string>& arguments, const std::filesystem::path& folder);
  void signal(int number) const;
  /// What it has written to standard output so far.
  std::string output() const;
  /// Waits for the end; call once.
  RunResult wait();

 private:
  int pid_;
  std::filesystem::path out_, err_;
};

/// Runs the program to its end.
RunResult run_voxlume(const std::vector<std::string>& arguments, const std::filesystem::path& folder = ".");

std::string file_text(const std::filesystem::path& path);
int line_count(const std::string& text);

}  // namespace voxlume::test
