#include "run_voxlume.h"

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <csignal>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace voxlume::test {

namespace fs = std::filesystem;

Process::Process(const std::vector<std::string>& arguments, const fs::path& folder) {
  static std::atomic<int> serial{0};
  const std::string stem = "voxlume-run-" + std::to_string(::getpid()) + "-" + std::to_string(serial++);
  out_ = fs::temp_directory_path() / (stem + ".out");
  err_ = fs::temp_directory_path() / (stem + ".err");
  std::vector<std::string> words{VOXLUME_BINARY};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);
  pid_ = ::fork();
  if (pid_ < 0) throw std::runtime_error("fork failed");
  if (pid_ > 0) return;
  const int in = ::open("/dev/null", O_RDONLY);
  const int out = ::open(out_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  const int err = ::open(err_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  if (::chdir(folder.c_str()) != 0 || ::dup2(in, 0) < 0 || ::dup2(out, 1) < 0 || ::dup2(err, 2) < 0)
    ::_exit(99);
  ::execv(argv[0], argv.data());
  ::_exit(98);
}

void Process::signal(int number) const { ::kill(pid_, number); }

std::string Process::output() const { return file_text(out_); }

RunResult Process::wait() {
  int status = 0;
  ::waitpid(pid_, &status, 0);
  RunResult run;
  run.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  run.out = file_text(out_);
  run.err = file_text(err_);
  fs::remove(out_);
  fs::remove(err_);
  return run;
}

RunResult run_voxlume(const std::vector<std::string>& arguments, const fs::path& folder) {
  return Process(arguments, folder).wait();
}

std::string file_text(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  std::stringstream text;
  text << file.rdbuf();
  return text.str();
}

int line_count(const std::string& text) {
  return static_cast<int>(std::count(text.begin(), text.end(), '\n'));
}

}  // namespace voxlume::test
