#include <arpa/inet.h>
#include <gmock/gmock.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "cli_fixture.h"

namespace voxlume::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// What a request for the address answers; empty where nobody listens.
std::string fetch(int port, const std::string& path, const std::string& cookie = "") {
  const int socket = ::socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_port = htons(static_cast<std::uint16_t>(port));
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  std::string answer;
  if (::connect(socket, reinterpret_cast<sockaddr*>(&address), sizeof address) == 0) {
    const std::string request = "GET " + path + " HTTP/1.1\r\nHost: 127.0.0.1:" + std::to_string(port) +
                                "\r\nCookie: " + cookie + "\r\nConnection: close\r\n\r\n";
    char block[4096];
    ::send(socket, request.data(), request.size(), MSG_NOSIGNAL);
    for (ssize_t n; (n = ::recv(socket, block, sizeof block, 0)) > 0;)
      answer.append(block, static_cast<std::size_t>(n));
  }
  ::close(socket);
  return answer;
}

class CliView : public CliTest {
 protected:
  /// Calls `done` until it is true, for half a minute at most.
  template <class Done>
  static bool eventually(Done done) {
    for (int i = 0; i < 1500; ++i) {
      if (done()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    return false;
  }
  /// The address that `view` printed.
  static std::string printed(const Process& process) {
    std::string line;
    eventually([&] { return (line = process.output()).ends_with('\n'); });
    return line.substr(0, line.size() - 1);
  }
  static int port_of(const std::string& url) { return std::stoi(url.substr(url.rfind(':') + 1)); }
  static std::string token_of(const std::string& url) { return url.substr(url.find("token=") + 6); }
};

TEST_F(CliView, WrongUsageIsRefusedInOneLine) {
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& message) {
    std::vector<std::string> all{"view", "--no-open"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const RunResult r = run(all);
    EXPECT_EQ(r.code, 2) << r.err;
    EXPECT_EQ(r.out, "");
    EXPECT_THAT(r.err, HasSubstr(message));
    EXPECT_EQ(line_count(r.err), 1) << r.err;
  };
  refused({"nothing.nrrd"}, "nothing.nrrd");
  refused({"--port", "70000"}, "--port");
  refused({"--port", "x"}, "--port");
  refused({"--folder", "nowhere"}, "nowhere");
  refused({"--bind", "not-an-address"}, "--bind");
  refused({"--bind", "192.0.2.1"}, "192.0.2.1");
  refused({"--threads", "0"}, "--threads");
  refused({"--max-upload", "-1"}, "--max-upload");
  refused({"ball.nrrd", "--spp", "0"}, "--spp");
  refused({"ball.nrrd", "--preset"}, "--preset");
  refused({"--porl", "1"}, "--port");
}

TEST_F(CliView, ServesUntilInterruptedAndEndsWithZero) {
  const fs::path temporary = folder_ / "tmp";
  fs::create_directories(temporary);
  ::setenv("TMPDIR", temporary.c_str(), 1);
  Process view({"view", "ball.nrrd", "--no-open", "--size", "24x20", "--spp", "2", "--preset", "generic"},
               folder_);
  ::unsetenv("TMPDIR");
  const std::string url = printed(view);
  ASSERT_THAT(url, testing::MatchesRegex("http://127\\.0\\.0\\.1:[0-9]+/\\?token=[0-9a-f]{32}"));
  const int port = port_of(url);
  const std::string cookie = "voxlume_" + std::to_string(port) + "=" + token_of(url);
  EXPECT_THAT(fetch(port, "/"), testing::StartsWith("HTTP/1.1 403"));
  EXPECT_THAT(fetch(port, "/?token=" + token_of(url)), HasSubstr("Set-Cookie: " + cookie));
  EXPECT_TRUE(eventually([&] { return fetch(port, "/api/volume", cookie).starts_with("HTTP/1.1 200"); }));
  const std::string scene = fetch(port, "/api/scene.json", cookie);
  EXPECT_THAT(scene, HasSubstr("\"preset\": \"generic\""));
  EXPECT_THAT(scene, HasSubstr("\"width\": 24"));
  EXPECT_FALSE(fs::is_empty(temporary));
  view.signal(SIGINT);
  const RunResult r = view.wait();
  EXPECT_EQ(r.code, 0) << r.err;
  EXPECT_EQ(r.err, "");
  EXPECT_TRUE(fs::is_empty(temporary));
  EXPECT_EQ(fetch(port, "/"), "");
}

TEST_F(CliView, StartsWithoutInputAndEndsByTerm) {
  Process view({"view", "--no-open"}, folder_);
  const std::string url = printed(view);
  const std::string cookie = "voxlume_" + std::to_string(port_of(url)) + "=" + token_of(url);
  EXPECT_THAT(fetch(port_of(url), "/api/volume", cookie), testing::StartsWith("HTTP/1.1 404"));
  EXPECT_THAT(fetch(port_of(url), "/api/files", cookie), HasSubstr("ball.nrrd"));
  view.signal(SIGTERM);
  EXPECT_EQ(view.wait().code, 0);
}

TEST_F(CliView, ATakenPortIsRefused) {
  Process view({"view", "--no-open"}, folder_);
  const std::string port = std::to_string(port_of(printed(view)));
  const RunResult second = run({"view", "--no-open", "--port", port});
  EXPECT_EQ(second.code, 2);
  EXPECT_THAT(second.err, HasSubstr(port));
  view.signal(SIGINT);
  EXPECT_EQ(view.wait().code, 0);
}

TEST_F(CliView, AnAddressThatOthersReachIsWarnedOf) {
  Process view({"view", "--no-open", "--bind", "0.0.0.0"}, folder_);
  const std::string url = printed(view);
  EXPECT_THAT(url, testing::StartsWith("http://0.0.0.0:"));
  view.signal(SIGINT);
  const RunResult r = view.wait();
  EXPECT_EQ(r.code, 0);
  EXPECT_THAT(r.err, testing::StartsWith("warning: "));
}

TEST_F(CliView, EveryStartHasATokenOfItsOwn) {
  Process one({"view", "--no-open"}, folder_), two({"view", "--no-open"}, folder_);
  EXPECT_NE(token_of(printed(one)), token_of(printed(two)));
  one.signal(SIGINT);
  two.signal(SIGINT);
  EXPECT_EQ(one.wait().code, 0);
  EXPECT_EQ(two.wait().code, 0);
}

}  // namespace
}  // namespace voxlume::test
