#include "server_fixture.h"

namespace voxlume::test {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

using Http = ServerTest;

TEST_F(Http, TokenGivesACookieOnce) {
  const Address& at = start();
  const Answer in = ask(at, {.path = "/?token=" + at.token, .cookie = ""});
  EXPECT_EQ(in.status, 303);
  EXPECT_EQ(in.header("Location"), "/");
  EXPECT_EQ(in.header("Set-Cookie"), at.cookie() + "; Path=/; HttpOnly; SameSite=Lax");
  EXPECT_EQ(get(at, "/").body, "<!doctype html>the page");
}

TEST_F(Http, WithoutTokenOrCookieNothingIsShown) {
  const Address& at = start();
  const std::string wrong(32, 'a');
  for (const std::string& path :
       std::vector<std::string>{"/", "/?token=", "/?token=" + wrong, "/assets/app.js", "/api/volume",
                                "/api/files", "/nothing", "/api/socket", "/api/files?token=" + at.token}) {
    const Answer refused = ask(at, {.path = path, .cookie = ""});
    EXPECT_EQ(refused.status, 403) << path;
    EXPECT_EQ(std::count(refused.body.begin(), refused.body.end(), '\n'), 1) << path;
    EXPECT_EQ(refused.header("Set-Cookie"), "");
  }
  EXPECT_THAT(ask(at, {.cookie = ""}).body, HasSubstr("token"));
  EXPECT_EQ(ask(at, {.cookie = "voxlume_1=" + at.token}).status, 403);
  EXPECT_EQ(ask(at, {.method = "PUT", .path = "/api/upload?name=x", .body = "x", .cookie = ""}).status, 403);
}

TEST_F(Http, ForeignHostsAndOriginsAreRefused) {
  const Address& at = start();
  EXPECT_EQ(ask(at, {.host = "evil.example"}).status, 403);
  EXPECT_EQ(ask(at, {.host = ""}).status, 403);
  EXPECT_EQ(ask(at, {.path = "/?token=" + at.token, .host = "evil.example", .cookie = ""}).status, 403);
  EXPECT_EQ(ask(at, {.headers = {{"Origin", "http://evil.example"}}}).status, 403);
  EXPECT_EQ(ask(at, {.headers = {{"Origin", "null"}}}).status, 403);
  EXPECT_EQ(ask(at, {.headers = {{"Origin", "http://localhost:" + std::to_string(at.port)}}}).status, 403);
  EXPECT_EQ(ask(at, {.headers = {{"Host", at.host()}}}).status, 403);  // two of them
  EXPECT_EQ(ask(at, {.headers = {{"Origin", "http://" + at.host()}}}).status, 200);
  EXPECT_EQ(ask(at, {.host = "localhost:5555"}).status, 200);  // a tunnel's
}

TEST_F(Http, ALinkOnAnotherSiteLeadsInAndNoFurther) {
  const Address& at = start();
  const std::vector<std::pair<std::string, std::string>> linked{{"Sec-Fetch-Site", "cross-site"},
                                                                {"Sec-Fetch-Mode", "navigate"}};
  EXPECT_EQ(ask(at, {.path = "/?token=" + at.token, .headers = linked, .cookie = ""}).status, 303);
  EXPECT_EQ(ask(at, {.headers = linked}).body, "<!doctype html>the page");
  for (const char* path : {"/api/files", "/api/scene.json", "/api/picture.png", "/assets/app.js"})
    EXPECT_EQ(ask(at, {.path = path, .headers = linked}).status, 403) << path;
  // What changes something is a PUT or a WebSocket, and those say whose page asks.
  for (const char* origin : {"http://evil.example", "null"})
    EXPECT_EQ(
        ask(at, {.method = "PUT", .path = "/api/upload?name=x", .body = "x", .headers = {{"Origin", origin}}})
            .status,
        403)
        << origin;
  EXPECT_THROW(Page(at, {.origin = "http://evil.example"}), std::runtime_error);
}

TEST_F(Http, PageFilesCarryTypeAndPolicy) {
  const Address& at = start();
  const Answer page = get(at, "/");
  EXPECT_EQ(page.header("Content-Type"), "text/html; charset=utf-8");
  EXPECT_THAT(page.header("Content-Security-Policy"), HasSubstr("default-src 'self'"));
  EXPECT_EQ(page.header("X-Content-Type-Options"), "nosniff");
  const Answer script = get(at, "/assets/app.js");
  EXPECT_EQ(script.body, "let x");
  EXPECT_EQ(script.header("Content-Type"), "text/javascript; charset=utf-8");
  const std::string tag = script.header("ETag");
  ASSERT_NE(tag, "");
  const Answer same = ask(at, {.path = "/assets/app.js", .headers = {{"If-None-Match", tag}}});
  EXPECT_EQ(same.status, 304);
  EXPECT_EQ(same.body, "");
  EXPECT_EQ(get(at, "/nothing.js").status, 404);
  EXPECT_EQ(get(at, "/assets").status, 404);
}

TEST_F(Http, PagePathsDoNotEscape) {
  const Address& at = start();
  fs::create_symlink(folder_ / "secret.nrrd", page_ / "link.html");
  for (const std::string& path : std::vector<std::string>{
           "/../secret.nrrd", "/%2e%2e/secret.nrrd", "/assets/../../secret.nrrd", "/..%2fsecret.nrrd",
           "/link.html", "//etc/passwd", "/%00", "/index.html%00.js", "/..\\secret.nrrd",
           "/assets/%2e%2e/%2e%2e/secret.nrrd"}) {
    const Answer answer = get(at, path);
    EXPECT_TRUE(answer.status == 404 || answer.status == 400) << path << answer.status;
    EXPECT_THAT(answer.body, testing::Not(HasSubstr("outside"))) << path;
  }
}

TEST_F(Http, WithoutAPageSaysHowToBuildOne) {
  server::ServerOptions without = options();
  without.page.clear();
  const Answer page = get(start(without), "/");
  EXPECT_EQ(page.status, 200);
  EXPECT_THAT(page.body, HasSubstr("./vx build"));
}

TEST_F(Http, WhileNothingIsOpenThereIsNothingToTell) {
  const Address& at = start();
  for (const char* path :
       {"/api/volume", "/api/labels", "/api/slice?axis=z&mm=0", "/api/histogram?of=x", "/api/histogram2?x=data&y=x", "/api/picture.png",
        "/api/scene.json", "/api/preset/ct-bone.png", "/api/export/a.mp4", "/api/nothing", "/api/"})
    EXPECT_EQ(get(at, path).status, 404) << path;
}

TEST_F(Http, OtherMethodsAndBodiesAreRefused) {
  const Address& at = start();
  for (const char* method : {"POST", "DELETE", "HEAD", "OPTIONS", "PATCH", "TRACE"})
    EXPECT_EQ(ask(at, {.method = method}).status, 400) << method;
  EXPECT_EQ(ask(at, {.body = "a body"}).status, 400);
  EXPECT_EQ(ask(at, {.method = "PUT", .path = "/", .body = "x"}).status, 404);
}

TEST_F(Http, FilesAreListedBelowTheFolderAlone) {
  const Address& at = start();
  const json root = json::parse(get(at, "/api/files").body);
  std::vector<std::string> names;
  for (const json& entry : root["entries"]) names.push_back(entry["name"]);
  EXPECT_THAT(names, testing::ElementsAre("inside", "labels.nrrd", "labels.txt", "ramp.nrrd"));
  EXPECT_EQ(json::parse(get(at, "/api/files?path=inside").body)["entries"].size(), 0u);
  for (const std::string& path :
       std::vector<std::string>{"..", "%2e%2e", "/", "/etc", "inside/../..", "%2Fetc", "..%2f", "a%00b"})
    EXPECT_EQ(get(at, "/api/files?path=" + path).status, 400) << path;
  EXPECT_EQ(get(at, "/api/files?path=nothing").status, 404);
  EXPECT_EQ(get(at, "/api/files?path=ramp.nrrd").status, 404);
}

TEST_F(Http, UploadsAreOpenedByTheirPath) {
  const Address& at = start();
  const Answer sent = ask(
      at, {.method = "PUT", .path = "/api/upload?name=sent.nrrd", .body = read_bytes(files_ / "ramp.nrrd")});
  ASSERT_EQ(sent.status, 200) << sent.body;
  Page page(at);
  page.send({{"type", "open"}, {"path", json::parse(sent.body)["path"]}});
  page.next("scene");
  EXPECT_EQ(json::parse(get(at, "/api/volume").body)["name"], "sent.nrrd");
}

TEST_F(Http, UploadsAreNeverReplaced) {
  const Address& at = start();
  const auto put = [&](const std::string& name, const std::string& text) {
    return fs::path(
        json::parse(ask(at, {.method = "PUT", .path = "/api/upload?name=" + name, .body = text}).body)["path"]
            .get<std::string>());
  };
  const fs::path head = put("a%20b.mhd", "first");
  EXPECT_EQ(head.filename(), "a b.mhd");
  const fs::path second = put("a%20b.mhd", "second");
  EXPECT_EQ(read_bytes(head), "first");
  EXPECT_EQ(read_bytes(second), "second");
  stop();
  EXPECT_FALSE(fs::exists(head));
}

TEST_F(Http, UploadNamesDoNotEscape) {
  const Address& at = start();
  for (const std::string& name : std::vector<std::string>{"", ".", "..", "../x", "a/b", "%2e%2e%2fx",
                                                          ".hidden", "a%5cb", "a%0ab", std::string(300, 'x')})
    EXPECT_EQ(ask(at, {.method = "PUT", .path = "/api/upload?name=" + name, .body = "x"}).status, 400)
        << name;
  EXPECT_EQ(ask(at, {.method = "PUT", .path = "/api/upload?name=%00", .body = "x"}).status, 400);
}

TEST_F(Http, UploadsBeyondTheLimitAreRefused) {
  server::ServerOptions small = options();
  small.most_upload_bytes = 1000;
  const Address& at = start(small);
  const auto put = [&](const std::string& name, std::size_t bytes) {
    return ask(at, {.method = "PUT", .path = "/api/upload?name=" + name, .body = std::string(bytes, 'x')})
        .status;
  };
  EXPECT_EQ(put("a", 1001), 413);
  EXPECT_EQ(put("a", std::size_t{8} << 20), 413);
  EXPECT_EQ(put("a", 600), 200);
  EXPECT_EQ(put("b", 600), 413);  // together
  EXPECT_EQ(put("b", 400), 200);
  // In pieces of which nobody says how many there are.
  std::string chunked = "PUT /api/upload?name=c HTTP/1.1\r\nHost: " + at.host() +
                        "\r\nCookie: " + at.cookie() + "\r\nTransfer-Encoding: chunked\r\n\r\n";
  for (int i = 0; i < 20; ++i) chunked += "64\r\n" + std::string(100, 'y') + "\r\n";
  EXPECT_EQ(parse_answer(talk(at.port, chunked + "0\r\n\r\n")).status, 413);
}

TEST_F(Http, AnUploadThatBreaksOffLeavesNothing) {
  const Address& at = start();
  talk(at.port,
       "PUT /api/upload?name=half HTTP/1.1\r\nHost: " + at.host() + "\r\nCookie: " + at.cookie() +
           "\r\nContent-Length: 1000000\r\n\r\nonly this",
       0.3);
  const Answer whole = ask(at, {.method = "PUT", .path = "/api/upload?name=whole", .body = "all"});
  const fs::path uploads =
      fs::path(json::parse(whole.body)["path"].get<std::string>()).parent_path().parent_path();
  // The server may hear of the end a moment later.
  for (int i = 0; i < 200 && std::distance(fs::directory_iterator(uploads), {}) > 1; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(std::distance(fs::directory_iterator(uploads), {}), 1);
}

TEST_F(Http, WhoeverWaitsForContinueGetsIt) {
  const Address& at = start();
  const std::string answer =
      talk(at.port, "PUT /api/upload?name=a HTTP/1.1\r\nHost: " + at.host() + "\r\nCookie: " + at.cookie() +
                        "\r\nConnection: close\r\nExpect: 100-continue\r\nContent-Length: 3\r\n\r\nabc");
  EXPECT_THAT(answer, testing::StartsWith("HTTP/1.1 100 Continue\r\n\r\nHTTP/1.1 200 OK"));
}

TEST_F(Http, DamageIsAnsweredOrDroppedAndTheServerLives) {
  const Address& at = start();
  const std::string host = "Host: " + at.host() + "\r\n";
  for (const std::string& bytes : std::vector<std::string>{
           std::string("\0\1\2\3garbage\r\n\r\n", 15), std::string("GET\r\n\r\n"),
           std::string("GET / HTTP/9.9\r\n\r\n"), "GET / HTTP/1.1\r\n" + host + "X: \1\r\n\r\n",
           "GET / HTTP/1.1\r\n" + host + "Content-Length: -5\r\n\r\n",
           "GET / HTTP/1.1\r\n" + host + "Content-Length: 5\r\nTransfer-Encoding: chunked\r\n\r\n",
           "GET / HTTP/1.1\r\n" + host + "X: " + std::string(20000, 'x') + "\r\n\r\n",
           "GET /" + std::string(20000, 'x') + " HTTP/1.1\r\n" + host + "\r\n",
           "GET http://evil/ HTTP/1.1\r\n" + host + "\r\n",
           std::string("\x16\x03\x01\x02\x00\x01\x00\x01\xfc\x03\x03", 11),
           std::string("PRI * HTTP/2.0\r\n\r\nSM\r\n\r\n"),
           "PUT /api/upload?name=x HTTP/1.1\r\n" + host + "Cookie: " + at.cookie() +
               "\r\nTransfer-Encoding: chunked\r\n\r\nzz\r\n"}) {
    const std::string answer = talk(at.port, bytes, 0.3);
    const int status = parse_answer(answer).status;
    EXPECT_TRUE(answer.empty() || status == 400 || status == 403 || status == 404)
        << status << bytes.substr(0, 40);
  }
  talk(at.port, "GET / HT", 0.1);
  talk(at.port, "", 0.1);
  EXPECT_EQ(get(at, "/").status, 200);
}

TEST_F(Http, ManyRequestsShareAConnection) {
  const Address& at = start();
  const std::string request =
      "GET /assets/app.js HTTP/1.1\r\nHost: " + at.host() + "\r\nCookie: " + at.cookie() + "\r\n";
  std::string bytes;
  for (int i = 0; i < 20; ++i) bytes += request + "\r\n";
  const std::string answers = talk(at.port, bytes + request + "Connection: close\r\n\r\n");
  std::size_t count = 0;
  for (std::size_t p = 0; (p = answers.find("let x", p)) != std::string::npos; ++p) ++count;
  EXPECT_EQ(count, 21u);
}

TEST_F(Http, ConnectionsThatSayNothingDoNotKeepOthersOut) {
  const Address& at = start();
  std::vector<std::thread> silent;
  for (int i = 0; i < 40; ++i) silent.emplace_back([&] { talk(at.port, "GET / HTTP/1.1\r\n", 1); });
  for (int i = 0; i < 10; ++i) EXPECT_EQ(get(at, "/").status, 200);
  for (std::thread& thread : silent) thread.join();
}

class HttpOfVolume : public ServerTest {
 protected:
  void SetUp() override {
    ServerTest::SetUp();
    start_with_ramp();
  }
  json data(const std::string& path) { return json::parse(get(*address_, path).body); }
};

TEST_F(HttpOfVolume, VolumeSaysWhatItIs) {
  const json volume = data("/api/volume");
  EXPECT_EQ(volume["name"], "ramp.nrrd");
  EXPECT_EQ(volume["size"], json({16, 16, 16}));
  EXPECT_EQ(volume["type"], "i16");
  EXPECT_EQ(volume["voxels"], 4096);
  EXPECT_EQ(volume["bounds_mm"], json({{-8, -8, -8}, {8, 8, 8}}));
  EXPECT_EQ(volume["direction"], json({1, 0, 0, 0, 1, 0, 0, 0, 1}));
  EXPECT_EQ(volume["range"], json({0, ramp(15, 15, 15)}));
  EXPECT_EQ(volume["hounsfield"], false);
  ASSERT_EQ(volume["histogram"]["counts"].size(), 512u);
  std::uint64_t sum = 0;
  for (const json& count : volume["histogram"]["counts"]) sum += count.get<std::uint64_t>();
  EXPECT_EQ(sum, 4096u);
  for (const char* p : {"0.1", "1", "5", "50", "95", "99", "99.9"})
    EXPECT_TRUE(volume["percentiles"].contains(p)) << p;
}

TEST_F(HttpOfVolume, SliceShowsTheVoxels) {
  const Answer answer = get(*address_, "/api/slice?axis=z&mm=-7.5");
  ASSERT_EQ(answer.status, 200);
  const json head = json::parse(answer.header("X-Slice"));
  ASSERT_EQ(head["width"], 16);
  ASSERT_EQ(head["height"], 16);
  EXPECT_EQ(head["origin_mm"], json({-7.5, -7.5}));
  ASSERT_EQ(answer.body.size(), 512u);
  for (std::size_t y = 0; y < 16; ++y) {
    for (std::size_t x = 0; x < 16; ++x) {
      const std::size_t at = 2 * (y * 16 + x);
      const int u =
          static_cast<unsigned char>(answer.body[at]) | static_cast<unsigned char>(answer.body[at + 1]) << 8;
      EXPECT_NEAR(head["offset"].get<double>() + head["scale"].get<double>() * (u - 1),
                  ramp(static_cast<int>(x), static_cast<int>(y), 0), 0.2);
    }
  }
  for (const char* wrong :
       {"", "?axis=z", "?axis=w&mm=0", "?axis=z&mm=", "?axis=z&mm=x", "?axis=z&mm=nan", "?axis=z&mm=1e999"})
    EXPECT_EQ(get(*address_, std::string("/api/slice") + wrong).status, 400) << wrong;
  EXPECT_EQ(get(*address_, "/api/slice?axis=z&mm=0&of=nothing").status, 404);
}

TEST_F(HttpOfVolume, LabelsThatOccurHaveNamesAndColours) {
  EXPECT_EQ(data("/api/labels"), json::object());
  Page page(*address_);
  page.send(edit(1, "/labels", {{"path", "labels.nrrd"}}));
  page.next("edited");
  const json labels = data("/api/labels");
  ASSERT_EQ(labels["labels"].size(), 2u);
  EXPECT_EQ(labels["labels"][0], json({{"value", 1}, {"name", "left"}, {"color", "#ff0000"}}));
  EXPECT_EQ(labels["labels"][1], json({{"value", 2}, {"name", "right"}, {"color", "#00ff00"}}));
  const Answer slice = get(*address_, "/api/slice?axis=z&mm=0.5&of=labels");
  const json head = json::parse(slice.header("X-Slice"));
  EXPECT_EQ(head["scale"], 1);
  EXPECT_EQ(head["offset"].get<double>() + slice.body[0] - 1, 1);
  EXPECT_EQ(head["offset"].get<double>() + slice.body[30] - 1, 2);
}

TEST_F(HttpOfVolume, ProxiesHaveHistograms) {
  Page page(*address_);
  page.send(edit(1, "/proxies", json::array({{{"name", "g"}, {"kind", "gradient"}}})));
  page.next("edited");
  const json histogram = data("/api/histogram?of=g");
  EXPECT_NEAR(histogram["hi"].get<double>(), std::sqrt(1 + 20 * 20 + 400 * 400), 0.5);
  EXPECT_EQ(histogram["counts"].size(), 512u);
  EXPECT_EQ(get(*address_, "/api/histogram?of=nothing").status, 404);
}

TEST_F(HttpOfVolume, TwoVolumesHaveAJointHistogram) {
  Page page(*address_);
  const json proxies = {{{"name", "sides"}, {"path", "labels.nrrd"}, {"lookup", "nearest"}},
                        {{"name", "g"}, {"kind", "gradient"}}};
  page.send(edit(1, "/proxies", proxies));
  page.next("edited");
  const json histogram = data("/api/histogram2?x=data&y=sides");
  const std::size_t columns = histogram["columns"], rows = histogram["rows"];
  EXPECT_EQ(histogram["x"], json({{"lo", 0}, {"hi", ramp(15, 15, 15)}}));
  EXPECT_EQ(histogram["y"], json({{"lo", 0.5}, {"hi", 2.5}}));
  ASSERT_EQ(rows, 2u);
  ASSERT_EQ(histogram["counts"].size(), columns * rows);
  // Half of the voxels are of each label.
  for (std::size_t row = 0; row < rows; ++row) {
    std::uint64_t sum = 0;
    for (std::size_t i = 0; i < columns; ++i) sum += histogram["counts"][row * columns + i].get<std::uint64_t>();
    EXPECT_EQ(sum, 2048u) << row;
  }
  // The least of the ramp's 128 bins has 0 to 49: two rows of 16 voxels, and the first ten of the third.
  EXPECT_EQ(histogram["counts"][0], 24);
  EXPECT_EQ(histogram["counts"][columns], 18);
  EXPECT_EQ(get(*address_, "/api/histogram2?x=data&y=sides").body,
            get(*address_, "/api/histogram2?x=data&y=sides").body);
  // The other way round it is the same, turned.
  const json turned = data("/api/histogram2?x=sides&y=data");
  for (std::size_t row = 0; row < rows; ++row)
    for (std::size_t i = 0; i < columns; ++i)
      ASSERT_EQ(turned["counts"][i * rows + row], histogram["counts"][row * columns + i]);
  EXPECT_EQ(data("/api/histogram2?x=g&y=g")["columns"], 128);
  for (const char* wrong : {"", "?x=data", "?x=data&y=nothing", "?x=labels&y=data", "?x=data&y=opacity"})
    EXPECT_EQ(get(*address_, std::string("/api/histogram2") + wrong).status, 404) << wrong;
}

TEST_F(HttpOfVolume, PictureIsOfFullSizeWithItsScene) {
  Page page(*address_);
  const Answer png = get(*address_, "/api/picture.png");
  ASSERT_EQ(png.status, 200) << png.body;
  EXPECT_EQ(png.header("Content-Disposition"), "attachment; filename=\"picture.png\"");
  EXPECT_EQ(png.body.substr(1, 3), "PNG");
  EXPECT_EQ(png.body.substr(16, 8), std::string("\0\0\0\x20\0\0\0\x18", 8));
  EXPECT_THAT(png.body, HasSubstr("voxlume:scene"));
  const Answer exr = get(*address_, "/api/picture.exr");
  EXPECT_EQ(exr.body.substr(0, 4), "\x76\x2f\x31\x01");
}

TEST_F(HttpOfVolume, PictureNeedsNobodyWatching) {
  EXPECT_EQ(get(*address_, "/api/picture.png").status, 200);
}

TEST_F(HttpOfVolume, SceneIsAFileThatCanBeLoaded) {
  const Answer answer = get(*address_, "/api/scene.json");
  EXPECT_EQ(answer.header("Content-Disposition"), "attachment; filename=\"scene.json\"");
  const json scene = json::parse(answer.body);
  EXPECT_EQ(scene["version"], 1);
  EXPECT_EQ(scene["image"]["width"], 32);
}

TEST_F(HttpOfVolume, ThumbnailsAreThereWhenTheyAreSaidToBe) {
  Page page(*address_);
  EXPECT_EQ(get(*address_, "/api/preset/nothing.png").status, 404);
  EXPECT_EQ(get(*address_, "/api/preset/ct-bone.png").status, 404);  // nobody asked for it
  const json hello = page.next("hello");
  page.next("scene");
  page.send({{"type", "draw_presets"}});
  std::vector<std::string> drawn;
  for (std::size_t i = 0; i < hello["presets"].size(); ++i) {
    drawn.push_back(page.next("preset_drawn")["name"]);
    const Answer answer = get(*address_, "/api/preset/" + drawn.back() + ".png");
    ASSERT_EQ(answer.status, 200) << drawn.back();
    EXPECT_EQ(answer.header("Content-Type"), "image/png");
    EXPECT_EQ(answer.body.substr(16, 8), std::string("\0\0\0\x80\0\0\0\x80", 8));
  }
  std::vector<std::string> presets;
  for (const json& preset : hello["presets"]) presets.push_back(preset["name"]);
  EXPECT_THAT(drawn, testing::UnorderedElementsAreArray(presets));
  // Another page is told at once, and they are the same pictures.
  const std::string before = get(*address_, "/api/preset/ct-bone.png").body;
  Page later(*address_);
  later.next("scene");
  later.send({{"type", "draw_presets"}});
  for (std::size_t i = 0; i < presets.size(); ++i) later.next("preset_drawn");
  EXPECT_EQ(get(*address_, "/api/preset/ct-bone.png").body, before);
}

TEST_F(HttpOfVolume, ThumbnailsOfAnEarlierVolumeAreGone) {
  Page page(*address_);
  page.next("scene");
  page.send({{"type", "draw_presets"}});
  const std::string name = page.next("preset_drawn")["name"];
  page.send({{"type", "open"}, {"path", "ramp.nrrd"}});
  page.next("scene");
  EXPECT_EQ(get(*address_, "/api/preset/" + name + ".png").status, 404);
  page.send({{"type", "draw_presets"}});
  page.next("preset_drawn");
}

}  // namespace
}  // namespace voxlume::test
