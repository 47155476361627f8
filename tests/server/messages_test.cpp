#include "server/messages.h"

#include <gtest/gtest.h>

#include "voxlume/error.h"

namespace voxlume::server {
namespace {

template <class T>
T read(const std::string& text) {
  return std::get<T>(parse_message(text));
}

TEST(Messages, AreRead) {
  const auto edit = read<EditMessage>(
      R"({"type":"edit","seq":7,"set":[["/camera/zoom",2],["/clip",null]],"gesture":"orbit-17","more":1})");
  EXPECT_EQ(edit.seq, 7);
  ASSERT_EQ(edit.set.size(), 2u);
  EXPECT_EQ(edit.set[0].first, "/camera/zoom");
  EXPECT_EQ(edit.set[0].second, 2);
  EXPECT_TRUE(edit.set[1].second.is_null());
  EXPECT_EQ(edit.gesture, "orbit-17");
  const auto passing =
      read<PassingMessage>(R"({"type":"passing","seq":8,"set":[["/lights/0/intensity",2]]})");
  EXPECT_EQ(passing.seq, 8);
  EXPECT_EQ(passing.set, (std::vector<FieldEdit>{{"/lights/0/intensity", 2}}));
  EXPECT_EQ(read<SplitMessage>(R"({"type":"split","at":0.5})").at, 0.5);
  EXPECT_EQ(read<SplitMessage>(R"({"type":"split","at":null})").at, std::nullopt);
  EXPECT_EQ(read<SeekMessage>(R"({"type":"seek","time_s":1.5})").time_s, 1.5);
  EXPECT_EQ(read<ProbeMessage>(R"({"type":"probe","id":3,"x":0.25,"y":1})").y, 1);
  EXPECT_EQ(read<ProbeMessage>(R"({"type":"probe","id":3,"x":0.25,"y":1})").position_mm, std::nullopt);
  EXPECT_EQ(read<ProbeMessage>(R"({"type":"probe","id":3,"position_mm":[1,-2.5,3]})").position_mm,
            Vec3d(1, -2.5, 3));
  EXPECT_EQ(read<OpenMessage>(R"({"type":"open","path":"a b"})").path, "a b");
  EXPECT_EQ(read<ShownMessage>(R"({"type":"shown","frame":12})").frame, 12u);
  EXPECT_EQ(read<ExportMessage>(R"({"type":"export","file":"a.zip"})").file, "a.zip");
  EXPECT_EQ(read<LoadMessage>(R"({"type":"load","scene":{"version":1}})").scene["version"], 1);
  EXPECT_NO_THROW(read<UndoMessage>(R"({"type":"undo"})"));
  EXPECT_NO_THROW(read<RedoMessage>(R"({"type":"redo"})"));
  EXPECT_NO_THROW(read<DrawPresetsMessage>(R"({"type":"draw_presets"})"));
  EXPECT_NO_THROW(read<CancelOpenMessage>(R"({"type":"cancel_open"})"));
  EXPECT_NO_THROW(read<CancelExportMessage>(R"({"type":"cancel_export"})"));
}

TEST(Messages, OfWrongShapeAreRefusedInOneLine) {
  for (const std::string text : {
           "",
           "x",
           "{",
           "[]",
           "1",
           "null",
           "{}",
           R"({"type":1})",
           R"({"type":"nothing"})",
           R"({"type":"edit"})",
           R"({"type":"edit","seq":1})",
           R"({"type":"edit","seq":1.5,"set":[]})",
           R"({"type":"edit","seq":"1","set":[]})",
           R"({"type":"edit","seq":1e300,"set":[]})",
           R"({"type":"edit","seq":1,"set":{}})",
           R"({"type":"edit","seq":1,"set":[1]})",
           R"({"type":"edit","seq":1,"set":[["/a"]]})",
           R"({"type":"edit","seq":1,"set":[[1,2]]})",
           R"({"type":"edit","seq":1,"set":[],"gesture":5})",
           R"({"type":"load"})",
           R"({"type":"load","scene":[]})",
           R"({"type":"open","path":null})",
           R"({"type":"split"})",
           R"({"type":"split","at":2})",
           R"({"type":"split","at":"x"})",
           R"({"type":"seek","time_s":-1})",
           R"({"type":"probe","id":1,"x":0.5})",
           R"({"type":"probe","id":1,"x":-0.1,"y":0})",
           R"({"type":"probe","id":1,"x":1e999,"y":0})",
           R"({"type":"probe","id":1,"position_mm":[1,2]})",
           R"({"type":"probe","id":1,"position_mm":[1,2,"3"]})",
           R"({"type":"probe","id":1,"position_mm":[1,2,1.1e12]})",
           R"({"type":"probe","id":1,"position_mm":[1,2,1e999]})",
           R"({"type":"shown","frame":-1})",
           R"({"type":"shown"})",
           R"({"type":"export"})",
           "{\"type\":\"op\nen\"}",
       }) {
    try {
      parse_message(text);
      ADD_FAILURE() << text;
    } catch (const Error& error) {
      EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << text;
    }
  }
}

TEST(Messages, NestedDeeplyAreRefused) {
  const std::string open(100000, '['), close(100000, ']');
  EXPECT_THROW(parse_message(open), Error);
  EXPECT_THROW(parse_message(R"({"type":"edit","seq":1,"set":[["/a",)" + open + close + "]]}"), Error);
  EXPECT_EQ(seq_of(R"({"seq":1,"set":)" + open + close + "}"), std::nullopt);
}

TEST(Messages, LongNamesAreRefused) {
  EXPECT_THROW(parse_message(R"({"type":"open","path":")" + std::string(5000, 'x') + "\"}"), Error);
}

TEST(Messages, SeqOfARefusedEditIsFound) {
  EXPECT_EQ(seq_of(R"({"type":"edit","seq":9,"set":5})"), 9);
  EXPECT_EQ(seq_of(R"({"type":"edit","seq":"9"})"), std::nullopt);
  EXPECT_EQ(seq_of("nonsense"), std::nullopt);
}

TEST(Messages, TextReplacesWhatIsNoUtf8) {
  EXPECT_EQ(text_of({{"path", "a\xFF"}}), "{\"path\":\"a\xEF\xBF\xBD\"}");
}

}  // namespace
}  // namespace voxlume::server
