#include "server/access.h"

#include <gtest/gtest.h>

#include <set>

namespace voxlume::server {
namespace {

TEST(Token, Has128BitsAndIsNewEveryTime) {
  std::set<std::string> seen;
  for (int i = 0; i < 100; ++i) {
    const std::string token = make_token();
    EXPECT_EQ(token.size(), 32u);
    EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
    seen.insert(token);
  }
  EXPECT_EQ(seen.size(), 100u);
}

TEST(Token, IsComparedWhole) {
  EXPECT_TRUE(equal_in_constant_time("abc", "abc"));
  for (const char* wrong : {"", "a", "ab", "abd", "abcd", "abcabc", "ABC"})
    EXPECT_FALSE(equal_in_constant_time(wrong, "abc")) << wrong;
}

TEST(Cookie, IsFoundAmongOthers) {
  EXPECT_EQ(cookie_value("voxlume_1=x", "voxlume_1"), "x");
  EXPECT_EQ(cookie_value("a=b; voxlume_1=x;c=d", "voxlume_1"), "x");
  EXPECT_EQ(cookie_value("voxlume_12=y; voxlume_1=x", "voxlume_1"), "x");
  for (const char* without : {"", "=", ";;;", "voxlume_1", "xvoxlume_1=x", "voxlume_12=x", "a=voxlume_1=x"})
    EXPECT_EQ(cookie_value(without, "voxlume_1"), "") << without;
}

TEST(Access, LetsInTheCookieItGave) {
  const Access access("0123456789abcdef", "127.0.0.1", 8080);
  EXPECT_EQ(access.set_cookie(), "voxlume_8080=0123456789abcdef; Path=/; HttpOnly; SameSite=Lax");
  EXPECT_TRUE(access.has_cookie("voxlume_8080=0123456789abcdef"));
  for (const char* wrong : {"", "voxlume_8080=", "voxlume_8080=0123456789abcdee",
                            "voxlume_8081=0123456789abcdef", "voxlume_8080=0123456789abcdef0"})
    EXPECT_FALSE(access.has_cookie(wrong)) << wrong;
}

TEST(Host, IsTheAddressBoundToOrLocalhostWithAnyPort) {
  const Access access("t", "127.0.0.1", 8080);
  for (const char* right : {"127.0.0.1:8080", "127.0.0.1", "localhost:1234", "LocalHost", "127.0.0.1:9"})
    EXPECT_TRUE(access.is_host(right)) << right;
  for (const char* wrong :
       {"", "evil.example", "evil.example:8080", "127.0.0.1.evil.example", "localhost.evil.example",
        "127.0.0.1:", "127.0.0.1:x", "127.0.0.1:123456", "127.0.0.2", "localhost:80:80", "[", "[::1]",
        "localhost@evil.example", "0.0.0.0"})
    EXPECT_FALSE(access.is_host(wrong)) << wrong;
}

TEST(Host, OfAnIpv6AddressIsInBrackets) {
  const Access access("t", "::1", 8080);
  EXPECT_TRUE(access.is_host("[::1]:8080"));
  EXPECT_TRUE(access.is_host("[::1]"));
  EXPECT_FALSE(access.is_host("::1"));
  EXPECT_FALSE(access.is_host("[::2]"));
}

TEST(Host, OfAServerAtEveryAddressIsAnyAddressButNoName) {
  const Access access("t", "0.0.0.0", 8080);
  EXPECT_TRUE(access.is_host("192.168.1.7:8080"));
  EXPECT_TRUE(access.is_host("[fe80::1]:8080"));
  EXPECT_TRUE(access.is_host("localhost:8080"));
  EXPECT_FALSE(access.is_host("evil.example:8080"));
}

TEST(Origin, HasTheHostAndPortOfTheRequest) {
  EXPECT_TRUE(is_same_origin("http://127.0.0.1:8080", "127.0.0.1:8080"));
  EXPECT_TRUE(is_same_origin("https://localhost:8443", "localhost:8443"));
  for (const char* wrong : {"", "null", "http://127.0.0.1", "http://127.0.0.1:8081", "http://evil.example",
                            "http://127.0.0.1:8080.evil.example", "http://evil.example/127.0.0.1:8080",
                            "ftp://127.0.0.1:8080", "127.0.0.1:8080"})
    EXPECT_FALSE(is_same_origin(wrong, "127.0.0.1:8080")) << wrong;
  EXPECT_FALSE(is_same_origin("http://", ""));
}

TEST(Access, OtherSitesPagesLeadToThePageAlone) {
  for (const char* own : {"", "same-origin", "none"}) {
    EXPECT_TRUE(may_ask(own, "/")) << own;
    EXPECT_TRUE(may_ask(own, "/api/scene.json")) << own;
  }
  for (const char* other : {"cross-site", "same-site"}) {
    EXPECT_TRUE(may_ask(other, "/")) << other;
    for (const char* path :
         {"/api/scene.json", "/api/upload", "/api/socket", "/assets/app.js", "/index.html"})
      EXPECT_FALSE(may_ask(other, path)) << other << path;
  }
}

TEST(Loopback, IsThisMachineAlone) {
  EXPECT_TRUE(is_loopback("127.0.0.1"));
  EXPECT_TRUE(is_loopback("::1"));
  for (const char* other : {"0.0.0.0", "::", "192.168.0.1", "localhost", ""})
    EXPECT_FALSE(is_loopback(other));
}

}  // namespace
}  // namespace voxlume::server
