#include "server/uploads.h"

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/read_until.hpp>
#include <boost/asio/write.hpp>

#include "server_fixture.h"
#include "voxlume/error.h"

namespace voxlume::test {
namespace {

namespace fs = std::filesystem;
using server::UploadSet;
using testing::HasSubstr;

class UploadsOfPages : public testing::Test {
 protected:
  /// Where the file came to lie, or its set.
  static fs::path send(server::Uploads& uploads, const std::string& name, const std::string& text,
                       const std::optional<UploadSet>& set = std::nullopt) {
    const auto incoming = uploads.begin(name, set);
    write_bytes(incoming->path(), text);
    return incoming->finish();
  }
  static std::string refusal(const std::function<void()>& act) {
    try {
      act();
    } catch (const Error& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder_;
};

TEST_F(UploadsOfPages, FilesOfASetLieTogether) {
  server::Uploads uploads(folder_ / "u", {.most_bytes = 1000});
  const UploadSet set{"1", "scan"};
  const fs::path scan = send(uploads, "a.dcm", "a", set);
  EXPECT_EQ(scan.filename(), "scan");
  EXPECT_EQ(send(uploads, "b.dcm", "b", set), scan);
  EXPECT_EQ(read_bytes(scan / "b.dcm"), "b");
  EXPECT_NE(send(uploads, "a.dcm", "c", UploadSet{"2", "scan"}), scan);
  EXPECT_EQ(read_bytes(scan / "a.dcm"), "a");
}

TEST_F(UploadsOfPages, NamesDoNotEscape) {
  server::Uploads uploads(folder_ / "u", {.most_bytes = 1000});
  for (const std::string& wrong : std::vector<std::string>{"", ".", "..", "../x", "a/b", "/etc", ".hidden",
                                                           "a\\b", "a\nb", std::string(300, 'x')}) {
    EXPECT_NE(refusal([&] { uploads.begin(wrong); }), "") << wrong;
    EXPECT_NE(refusal([&] { uploads.begin("a", UploadSet{wrong, "scan"}); }), "") << wrong;
    EXPECT_NE(refusal([&] { uploads.begin("a", UploadSet{"1", wrong}); }), "") << wrong;
    EXPECT_NE(refusal([&] { uploads.begin(wrong, UploadSet{"1", "scan"}); }), "") << wrong;
  }
  EXPECT_TRUE(fs::is_empty(folder_ / "u"));
}

TEST_F(UploadsOfPages, SetsAreBounded) {
  server::Uploads uploads(folder_ / "u", {.most_bytes = 1000, .most_files_of_set = 3});
  const UploadSet set{"1", "scan"};
  for (const char* name : {"a", "b", "c"}) send(uploads, name, std::string(100, 'x'), set);
  EXPECT_EQ(uploads.room(), 700u);
  EXPECT_THAT(refusal([&] { uploads.begin("d", set); }), HasSubstr("at most 3 files"));
  EXPECT_EQ(uploads.room(), 1000u);  // given up as a whole
}

TEST_F(UploadsOfPages, ASetThatBreaksOffIsGone) {
  server::Uploads uploads(folder_ / "u", {.most_bytes = 1000});
  const UploadSet set{"1", "scan"};
  const fs::path scan = send(uploads, "a.dcm", "aaa", set);
  send(uploads, "alone", "b");
  { const auto broken = uploads.begin("b.dcm", set); }
  EXPECT_FALSE(fs::exists(scan));
  EXPECT_EQ(uploads.room(), 999u);
  EXPECT_NE(refusal([&] {
              send(uploads, "a", "x", UploadSet{"2", "s"}), send(uploads, "a", "y", UploadSet{"2", "s"});
            }),
            "");  // twice the same name
}

TEST_F(UploadsOfPages, ASetIsGoneWithWhateverIsRefusedOfIt) {
  server::Uploads uploads(folder_ / "u", {.most_bytes = 1000});
  const UploadSet set{"1", "scan"};
  const fs::path scan = send(uploads, "a.dcm", "aaa", set);
  EXPECT_NE(refusal([&] { uploads.begin("../b.dcm", set); }), "");
  EXPECT_FALSE(fs::exists(scan));
  EXPECT_EQ(uploads.room(), 1000u);
  // What was still on its way to it does not begin it anew.
  EXPECT_THAT(refusal([&] { uploads.begin("c.dcm", set); }), HasSubstr("send all of it again"));
  EXPECT_EQ(uploads.room(), 1000u);
}

TEST_F(UploadsOfPages, ASetThatNobodyGoesOnWithIsGone) {
  server::Uploads uploads(folder_ / "u", {.most_bytes = 1000, .patience = std::chrono::seconds(0)});
  const fs::path opened = send(uploads, "o.dcm", "o", UploadSet{"1", "opened"});
  uploads.opened_as(opened);
  const auto slow = uploads.begin("s.dcm", UploadSet{"2", "slow"});
  const fs::path left = send(uploads, "l.dcm", "l", UploadSet{"3", "left"});
  send(uploads, "alone", "a");
  EXPECT_TRUE(fs::exists(opened));
  EXPECT_FALSE(fs::exists(left));
  write_bytes(slow->path(), "s");
  EXPECT_TRUE(fs::exists(slow->finish()));
  EXPECT_EQ(uploads.room(), 997u);
}

TEST_F(UploadsOfPages, WhatIsGivenUpIsGoneUnlessItWasKept) {
  server::Uploads uploads(folder_ / "u", {.most_bytes = 1000});
  const fs::path first = send(uploads, "a.nrrd", "aaa"), second = send(uploads, "a.nrrd", "bbbb");
  EXPECT_EQ(uploads.find("a.nrrd"), second);
  uploads.give_up(second);
  EXPECT_FALSE(fs::exists(second));
  EXPECT_EQ(uploads.room(), 997u);
  EXPECT_EQ(uploads.find("a.nrrd"), first);
  uploads.keep(first);
  uploads.give_up(first);
  EXPECT_EQ(read_bytes(first), "aaa");
  const fs::path scan = send(uploads, "1.dcm", "x", UploadSet{"1", "scan"});
  uploads.give_up(scan);  // not complete: it may still get files
  EXPECT_TRUE(fs::exists(scan));
  uploads.opened_as(scan);
  uploads.give_up(scan);
  EXPECT_FALSE(fs::exists(scan));
  EXPECT_EQ(uploads.find("scan"), "");
  EXPECT_EQ(uploads.room(), 997u);
  write_bytes(folder_ / "mine", "m");
  uploads.give_up(folder_ / "mine");
  uploads.give_up(folder_ / "u");
  EXPECT_TRUE(fs::exists(folder_ / "mine"));
  EXPECT_TRUE(fs::exists(first));
}

TEST_F(UploadsOfPages, TextsCallThemByTheirNamesAlone) {
  server::Uploads uploads(folder_ / "u", {.most_bytes = 1000});
  const fs::path one = send(uploads, "a b.nrrd", "x");
  EXPECT_EQ(uploads.with_names_alone(one.string() + ": is damaged, as " + one.string()),
            "a b.nrrd: is damaged, as a b.nrrd");
  for (const std::string& other :
       {std::string("/data/7/a.nrrd is odd"), (folder_ / "u").string() + "/x/a.nrrd"})
    EXPECT_EQ(uploads.with_names_alone(other), other);
}

TEST_F(UploadsOfPages, WhatIsReservedTakesRoomBeforeItIsThere) {
  server::Uploads uploads(folder_ / "u", {.most_bytes = 1000});
  auto first = uploads.begin("a");
  first->reserve(600);
  EXPECT_EQ(uploads.room(), 400u);
  write_bytes(first->path(), std::string(500, 'x'));
  EXPECT_EQ(uploads.room(), 400u);
  first->finish();
  first.reset();
  EXPECT_EQ(uploads.room(), 500u);
}

TEST_F(UploadsOfPages, WhatIsOnItsWayTakesRoom) {
  server::Uploads uploads(folder_ / "u", {.most_bytes = 1000});
  const auto incoming = uploads.begin("a");
  write_bytes(incoming->path(), std::string(600, 'x'));
  EXPECT_EQ(uploads.room(), 400u);
}

TEST_F(UploadsOfPages, AFileOnItsWayOutlivesTheUploads) {
  std::unique_ptr<server::Uploads::Incoming> incoming;
  {
    server::Uploads uploads(folder_ / "u", {.most_bytes = 1000});
    incoming = uploads.begin("a", UploadSet{"1", "scan"});
    write_bytes(incoming->path(), "x");
  }
  incoming.reset();
  EXPECT_TRUE(fs::is_empty(folder_ / "u/1/scan"));
}

TEST_F(UploadsOfPages, ASetIsOpenedAsTheOneThingThatItIs) {
  server::Uploads uploads(folder_ / "u", {.most_bytes = 100000});
  int sets = 0;
  const auto opened = [&](const std::vector<std::pair<std::string, std::string>>& files) {
    const UploadSet set{std::to_string(++sets), "scan"};
    fs::path folder;
    for (const auto& [name, text] : files) folder = send(uploads, name, text, set);
    return uploads.opened_as(folder).filename();
  };
  EXPECT_EQ(opened({{"1", ""}, {"2", ""}}), "scan");
  EXPECT_EQ(opened({{"1.dcm", ""}, {"2.dcm", ""}, {"notes.txt", ""}}), "scan");
  EXPECT_EQ(opened({{"1.tif", ""}, {"2.tiff", ""}}), "scan");
  EXPECT_EQ(opened({{"a.raw", ""}, {"a.nhdr", "NRRD0004\ndata file: a.raw\n\n"}}), "a.nhdr");
  EXPECT_EQ(opened({{"a.mhd", "ElementDataFile = a.raw\n"}, {"a.raw", ""}}), "a.mhd");
  EXPECT_EQ(opened({{"labels.nii.gz", ""}, {"labels.txt", ""}, {"labels.json", R"({"EchoTime":1})"}}),
            "labels.nii.gz");
  EXPECT_EQ(opened({{"a.nrrd", ""}, {"a.json", R"({"volume":{"path":"a.nrrd"}})"}, {"b.nrrd", ""}}),
            "a.json");
  for (const auto& [files, expected] :
       std::vector<std::pair<std::vector<std::pair<std::string, std::string>>, std::string>>{
           {{{"a.nrrd", ""}, {"b.nrrd", ""}}, "found a.nrrd, b.nrrd"},
           {{{"a.nrrd", ""}, {"1.tif", ""}, {"2.tif", ""}}, "found a.nrrd, 1.tif"},
           {{{"1.dcm", ""}, {"1.tif", ""}}, "found 1.tif, 1.dcm"},
           {{{"a.nhdr", "NRRD0004\ndata file: a.raw\n\n"}}, "its voxels are in a.raw"}}) {
    const std::uint64_t before = uploads.room();
    EXPECT_THAT(refusal([&, &sent = files] { opened(sent); }), HasSubstr(expected));
    EXPECT_EQ(uploads.room(), before);  // what cannot be opened is not kept
  }
}

TEST_F(UploadsOfPages, WhatIsTooLargeForASceneIsNone) {
  server::Uploads uploads(folder_ / "u", {.most_bytes = 1u << 30});
  const UploadSet set{"1", "scan"};
  send(uploads, "a.nrrd", "", set);
  const fs::path folder =
      send(uploads, "a.json", R"({"volume":{}})" + std::string(std::size_t{64} << 20, ' '), set);
  EXPECT_EQ(uploads.opened_as(folder).filename(), "a.nrrd");
}

class UploadsToServer : public ServerTest {
 protected:
  static Answer put(const Address& at, const std::string& query, const std::string& bytes) {
    return ask(at, {.method = "PUT", .path = "/api/upload?" + query, .body = bytes});
  }
  /// Sends a file of the server's folder; its path there.
  std::string upload(const std::string& name) {
    return json::parse(put(*address_, "name=" + name, read_bytes(files_ / name)).body)["path"];
  }
  std::string open_failure(Page& page, const std::string& path) {
    page.send({{"type", "open"}, {"path", path}});
    return page.next("status", [](const json& m) { return m["stage"] == "failed"; })["message"];
  }
  /// The folder of a set of these files.
  std::string send_set(const std::string& id, const fs::path& folder) {
    std::string path;
    for (const auto& file : fs::directory_iterator(folder)) {
      const Answer sent = put(*address_, "set=" + id + "&folder=scan&name=" + file.path().filename().string(),
                              read_bytes(file.path()));
      EXPECT_EQ(sent.status, 200) << sent.body;
      path = json::parse(sent.body)["path"];
    }
    return path;
  }
};

TEST_F(UploadsToServer, ADicomSeriesIsOpenedAsOneVolume) {
  start();
  write_volume(make_volume<std::int16_t>({8, 8, 5}, ramp), (folder_ / "series").string() + "/");
  Page page(*address_);
  page.send({{"type", "open"}, {"path", send_set("a1", folder_ / "series")}});
  page.next("scene");
  const json volume = json::parse(get(*address_, "/api/volume").body);
  EXPECT_EQ(volume["name"], "scan");
  EXPECT_EQ(volume["size"], json({8, 8, 5}));
}

TEST_F(UploadsToServer, AHeaderIsOpenedWithItsVoxels) {
  start();
  fs::create_directories(folder_ / "pair");
  write_bytes(folder_ / "pair/a.nhdr",
              "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\ndata file: a.raw\n\n");
  write_bytes(folder_ / "pair/a.raw", std::string(63, '\1') + '\2');
  Page page(*address_);
  page.send({{"type", "open"}, {"path", send_set("a1", folder_ / "pair")}});
  page.next("scene");
  EXPECT_EQ(json::parse(get(*address_, "/api/volume").body)["name"], "a.nhdr");
  const json beside = json::parse(get(*address_, "/api/scene.json").header("X-Beside"));
  EXPECT_EQ(beside, json({"a.nhdr", "a.raw"}));
}

TEST_F(UploadsToServer, SetsThatCannotBeOpenedSayWhy) {
  start();
  Page page(*address_);
  fs::create_directories(folder_ / "mixed");
  for (const char* name : {"a.nrrd", "b.nrrd"}) write_bytes(folder_ / "mixed" / name, "NRRD0004\n");
  EXPECT_THAT(open_failure(page, send_set("m", folder_ / "mixed")), HasSubstr("found a.nrrd, b.nrrd"));
  const Answer alone = put(*address_, "name=a.mhd", "ElementDataFile = a.raw\n");
  EXPECT_THAT(open_failure(page, json::parse(alone.body)["path"]), HasSubstr("its voxels are in a.raw"));
  fs::create_directories(folder_ / "texts");
  write_bytes(folder_ / "texts/a.txt", "nothing");
  EXPECT_NE(open_failure(page, send_set("t", folder_ / "texts")), "");
  fs::create_directories(folder_ / "out");
  write_bytes(folder_ / "out/a.nhdr", "NRRD0004\ndata file: " + (folder_ / "secret.nrrd").string() + "\n\n");
  EXPECT_THAT(open_failure(page, send_set("o", folder_ / "out")), HasSubstr("outside"));
}

TEST_F(UploadsToServer, ASetOfLabelsBringsTheirNames) {
  Page page(start_with_ramp());
  fs::create_directories(folder_ / "atlas");
  for (const char* name : {"labels.nrrd", "labels.txt"}) fs::copy(files_ / name, folder_ / "atlas" / name);
  page.send(edit(1, "/labels", {{"path", send_set("l", folder_ / "atlas")}}));
  const json edited = page.next("edited");
  EXPECT_THAT(edited["sections"]["labels"]["path"].get<std::string>(),
              testing::EndsWith("/scan/labels.nrrd"));
  EXPECT_EQ(json::parse(get(*address_, "/api/labels").body)["labels"][0]["name"], "left");
  // No way out of the folder by its name.
  page.send(edit(2, "/labels",
                 {{"path", edited["sections"]["labels"]["path"].get<std::string>() + "/../../../.."}}));
  EXPECT_THAT(page.next("refused")["message"].get<std::string>(), HasSubstr("outside"));
}

TEST_F(UploadsToServer, SetsStayInTheirFolderAndLimits) {
  server::ServerOptions small = options();
  small.most_upload_bytes = 1000;
  const Address& at = start(small);
  for (const std::string& query : std::vector<std::string>{
           "set=..&folder=a&name=b", "set=a%2Fb&folder=a&name=b", "set=&folder=a&name=b",
           "set=a&folder=..&name=b", "set=a&folder=%2Fetc&name=b", "set=a&folder=.x&name=b", "set=a&name=b",
           "set=a&folder=b&name=..", "set=a&folder=b&name=c%2Fd", "set=a&folder=b&name=.d"})
    EXPECT_EQ(put(at, query, "x").status, 400) << query;
  EXPECT_EQ(put(at, "set=a&folder=b&name=c", std::string(600, 'x')).status, 200);
  EXPECT_EQ(put(at, "set=a&folder=b&name=d", std::string(600, 'x')).status, 413);
  // The set is given up, and its room is there again.
  EXPECT_EQ(put(at, "name=c", std::string(1000, 'x')).status, 200);
}

TEST_F(UploadsToServer, WhatCannotBeOpenedGivesItsRoomBack) {
  server::ServerOptions small = options();
  small.most_upload_bytes = 20000;
  Page page(start(small));
  const std::string large(15000, 'x');
  const auto sent = [&](const std::string& query, const std::string& bytes) {
    const Answer answer = put(*address_, query, bytes);
    EXPECT_EQ(answer.status, 200) << query << ": " << answer.body;
    return answer.status == 200 ? json::parse(answer.body)["path"].get<std::string>() : "";
  };
  int set = 0;
  const auto of_set = [&](const std::string& name) {
    return "set=" + std::to_string(set) + "&folder=scan&name=" + name;
  };
  // Each takes more than half of the room; the next one finds it free again.
  const std::string no_volume = sent("name=a.nrrd", large);
  EXPECT_NE(open_failure(page, no_volume), "");
  EXPECT_FALSE(fs::exists(no_volume));
  ++set;
  EXPECT_NE(open_failure(page, sent(of_set("a.dcm"), large)), "");
  ++set;
  sent(of_set("a.raw"), large);
  const std::string outside = "NRRD0004\ndata file: " + (folder_ / "secret.nrrd").string() + "\n\n";
  EXPECT_THAT(open_failure(page, sent(of_set("a.nhdr"), outside)), HasSubstr("outside"));
  ++set;
  sent(of_set("a.nrrd"), large);
  EXPECT_NE(open_failure(page, sent(of_set("a.json"), R"({"volume":{"path":"b.nrrd"}})")), "");
  EXPECT_NE(open_failure(page, sent("name=a.mhd", "ElementDataFile = a.raw\n" + large)), "");
  ++set;
  sent(of_set("a.dcm"), large);
  EXPECT_EQ(put(*address_, of_set(".b.dcm"), "x").status, 400);
  EXPECT_EQ(put(*address_, of_set("c.dcm"), "x").status, 400);
  // What was opened stays, whatever is tried with it.
  ++set;
  const fs::path voxels = fs::path(sent(of_set("a.raw"), std::string(63, '\1') + '\2')) / "a.raw";
  const std::string pair =
      sent(of_set("a.nhdr"),
           "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 4 4 4\nencoding: raw\ndata file: a.raw\n\n");
  page.send({{"type", "open"}, {"path", pair}});
  page.next("scene");
  EXPECT_NE(open_failure(page, voxels.string()), "");
  EXPECT_TRUE(fs::exists(voxels));
}

TEST_F(UploadsToServer, TwoAtATimeDoNotShareTheirRoom) {
  server::ServerOptions small = options();
  small.most_upload_bytes = 1000;
  const Address& at = start(small);
  const std::string slow = "PUT /api/upload?name=slow HTTP/1.1\r\nHost: " + at.host() +
                           "\r\nCookie: " + at.cookie() +
                           "\r\nExpect: 100-continue\r\nContent-Length: 600\r\n\r\n";
  boost::asio::io_context io;
  boost::asio::ip::tcp::socket first(io);
  first.connect({boost::asio::ip::make_address("127.0.0.1"), at.port});
  boost::asio::write(first, boost::asio::buffer(slow));
  std::string answer;
  boost::asio::read_until(first, boost::asio::dynamic_buffer(answer), "100 Continue\r\n\r\n");
  EXPECT_EQ(put(at, "name=second", std::string(600, 'x')).status, 413);
  EXPECT_EQ(put(at, "name=third", std::string(400, 'x')).status, 200);
}

class SavedScene : public UploadsToServer {
 protected:
  json saved() {
    const Answer answer = get(*address_, "/api/scene.json");
    EXPECT_EQ(answer.status, 200) << answer.body;
    EXPECT_THAT(answer.body, testing::Not(HasSubstr("voxlume-view")));
    beside_ = json::parse(answer.header("X-Beside"));
    return json::parse(answer.body);
  }
  json beside_;
};

TEST_F(SavedScene, NamesUploadsByTheirNamesAndFindsThem) {
  start();
  Page page(*address_);
  const std::string volume = upload("ramp.nrrd");
  page.send({{"type", "open"}, {"path", volume}});
  page.next("scene");
  const std::string labels = upload("labels.nrrd");
  write_bytes(files_ / "sky.hdr", "no picture");
  const std::string sky = upload("sky.hdr");
  page.send(edit(1, "/labels", {{"path", labels}}));
  page.next("edited");
  page.send(edit(2, "/proxies", json::array({{{"name", "p"}, {"path", volume}}})));
  page.next("edited");
  page.send(edit(3, "/environment/image", sky));
  page.next("edited");
  const json scene = saved();
  EXPECT_EQ(scene["volume"]["path"], "ramp.nrrd");
  EXPECT_EQ(scene["labels"]["path"], "labels.nrrd");
  EXPECT_EQ(scene["proxies"][0]["path"], "ramp.nrrd");
  EXPECT_EQ(scene["environment"]["image"], "sky.hdr");
  EXPECT_THAT(beside_, testing::UnorderedElementsAre("labels.nrrd", "ramp.nrrd", "sky.hdr"));
  // The folder has files of these names as well: what was uploaded is meant.
  page.send(edit(4, "/environment/image", ""));
  page.next("edited");
  page.send({{"type", "load"}, {"scene", saved()}});
  const json loaded = page.next("scene")["scene"];
  EXPECT_EQ(loaded["volume"]["path"], volume);
  EXPECT_EQ(loaded["labels"]["path"], labels);
}

TEST_F(SavedScene, OfAFileOfTheFolderIsAsBefore) {
  start_with_ramp();
  const Answer answer = get(*address_, "/api/scene.json");
  EXPECT_EQ(json::parse(answer.body)["volume"]["path"], (files_ / "ramp.nrrd").string());
  EXPECT_EQ(answer.header("X-Beside"), "");
}

TEST_F(SavedScene, IsFoundFromAFileOfTheFolderToo) {
  start();
  Page page(*address_);
  fs::copy(files_ / "ramp.nrrd", folder_ / "mine.nrrd");
  const std::string volume =
      json::parse(put(*address_, "name=mine.nrrd", read_bytes(folder_ / "mine.nrrd")).body)["path"];
  page.send({{"type", "open"}, {"path", volume}});
  page.next("scene");
  write_bytes(files_ / "inside/saved.json", saved().dump());
  page.send({{"type", "open"}, {"path", "inside/saved.json"}});
  EXPECT_EQ(page.next("scene")["scene"]["volume"]["path"], volume);
  // What lies beside the scene comes first.
  fs::copy(folder_ / "mine.nrrd", files_ / "inside/mine.nrrd");
  page.send({{"type", "open"}, {"path", "inside/saved.json"}});
  EXPECT_EQ(page.next("scene")["scene"]["volume"]["path"],
            (fs::canonical(files_) / "inside/mine.nrrd").string());
}

TEST_F(SavedScene, WithoutItsUploadSaysWhatIsMissing) {
  Page page(start());
  page.send({{"type", "load"}, {"scene", {{"version", 1}, {"volume", {{"path", "gone.nrrd"}}}}}});
  EXPECT_THAT(
      page.next("status", [](const json& m) { return m["stage"] == "failed"; })["message"].get<std::string>(),
      testing::AllOf(HasSubstr("gone.nrrd"), HasSubstr("drop it")));
}

TEST_F(SavedScene, OfASeriesNamesItsFolder) {
  start();
  write_volume(make_volume<std::int16_t>({8, 8, 5}, ramp), (folder_ / "series").string() + "/");
  Page page(*address_);
  const std::string scan = send_set("a", folder_ / "series");
  page.send({{"type", "open"}, {"path", scan}});
  page.next("scene");
  const json scene = saved();
  EXPECT_EQ(scene["volume"]["path"], "scan");
  EXPECT_EQ(beside_, json({"scan"}));
  page.send({{"type", "load"}, {"scene", scene}});
  EXPECT_EQ(page.next("scene")["scene"]["volume"]["path"], scan);
}

TEST_F(SavedScene, WithTwoUploadsOfOneNameIsRefused) {
  start();
  Page page(*address_);
  page.send({{"type", "open"}, {"path", upload("labels.nrrd")}});
  page.next("scene");
  page.send(edit(1, "/labels", {{"path", upload("labels.nrrd")}}));
  page.next("edited");
  const Answer answer = get(*address_, "/api/scene.json");
  EXPECT_EQ(answer.status, 400);
  EXPECT_THAT(answer.body, HasSubstr("labels.nrrd"));
}

}  // namespace
}  // namespace voxlume::test
