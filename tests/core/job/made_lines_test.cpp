#include "core/job/made_lines.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/job/parse.h"
#include "core/job/scene_document.h"
#include "core/job/yaml_build.h"
#include "core/job/yaml_writer.h"
#include "test_assets.h"

namespace hyades::core {
namespace {

using testing::HasSubstr;

TEST(MadeLines, MarksTellTheLinesBelowThem) {
  const MadeLines lines("a: 1\n#line 7\nb: 2\nc: 3\n#line 3 parts/roof.lua\nd: 4\n", "in/s.lua");
  const auto told = [&](int line) {
    const YamlPlace place = lines.at(line, 4);
    return *place.file + ":" + std::to_string(place.line) + ":" + std::to_string(place.column);
  };
  EXPECT_EQ(told(1), "in/s.lua:0:0");
  EXPECT_EQ(told(3), "in/s.lua:7:0");
  EXPECT_EQ(told(4), "in/s.lua:7:0");
  EXPECT_EQ(told(6), "in/parts/roof.lua:3:0");
  EXPECT_EQ(lines.other_files(), std::set<std::string>{"in/parts/roof.lua"});
  const YamlPlace plain = MadeLines("#line 7\nb: 2\n", "job.yaml").at(2, 4);
  EXPECT_EQ(plain.line, 2) << "marks mean nothing in what no script made";
  EXPECT_EQ(plain.column, 4);
}

TEST(MadeLines, OfManyFilesTheFirstAreToldApart) {
  std::string text;
  for (int i = 0; i < 300; ++i) text += "#line 1 f" + std::to_string(i) + ".lua\na: 1\n";
  text += "#line 5 f0.lua\na: 1\n";
  const MadeLines lines(text, "in/s.lua");
  EXPECT_EQ(lines.other_files().size(), 256U);
  EXPECT_EQ(*lines.at(2, 1).file, "in/f0.lua");
  EXPECT_EQ(*lines.at(512, 1).file, "in/f255.lua");
  EXPECT_EQ(*lines.at(514, 1).file, "in/s.lua");
  EXPECT_EQ(lines.at(2, 1).file, lines.at(602, 1).file) << "one name in memory, however many marks";
}

TEST(MadeLines, AreWrittenWhereTheyChange) {
  const auto at = [](const YamlPtr& node, const char* file, int line) {
    auto placed = std::make_shared<YamlNode>(*node);
    placed->where = {std::make_shared<const std::string>(file), line, 0};
    return YamlPtr(placed);
  };
  const YamlMap root{{"a", at(yaml_integer(1), "s.lua", 4)},
                     {"b", at(yaml_integer(2), "s.lua", 5)},
                     {"c", at(yaml_integer(3), "p.lua", 5)},
                     {"d", yaml_integer(4)}};
  EXPECT_EQ(write_yaml_of_script(*root.node(), "s.lua"),
            "#line 4\na: 1\n#line 5\nb: 2\n#line 5 p.lua\nc: 3\nd: 4\n");
  EXPECT_EQ(write_yaml(*root.node()), "a: 1\nb: 2\nc: 3\nd: 4\n");
}

TEST(ScriptDocument, ItsReferenceLiesBesideTheScript) {
  SceneDocument wanted;
  wanted.scene = "x/a,b.lua";
  wanted.fps = 0.0F;
  wanted.frames = "1-48x2";
  wanted.set = {{"seed", "3"}, {"roof", "red, = 5 %/.."}};
  const std::string reference = reference_of(wanted);
  EXPECT_EQ(reference,
            "x/a,b.lua,fps=0,frames=1-48x2,set.seed=3,set.roof=red%2C%20%3D%205%20%25%2F...yaml");
  const auto back = document_of(reference);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->scene, wanted.scene);
  EXPECT_EQ(back->fps, 0.0F);
  EXPECT_EQ(back->frames, wanted.frames);
  EXPECT_EQ(back->set, wanted.set);
  for (const char* other : {"a.lua.yaml", "a.lua,set.1x=3.yaml", "a.lua,set.=3.yaml",
                            "a.glb,fps=24.yaml", "a.lua,who=me.yaml", "a.lua,fps=24.yml"}) {
    EXPECT_FALSE(document_of(other)) << other;
  }
}

TEST(ScriptDocument, AJobIncludesItWithSettingsAndFrames) {
  MemoryAssets assets;
  assets.add("in/s.lua,fps=30,frames=1-4,set.n=3.yaml", "#line 9\nobjects: {a: {shape: cone}}\n");
  assets.add("in/s.lua,fps=0.yaml", "objects: {a: {shape: box}}\n");
  Diagnostics diagnostics;
  parse_job("hyades: 1\nframes: {range: 1-4, fps: 30}\ninclude: {lua: in/s.lua, set: {n: 3}}\n",
            "job.yaml", assets, diagnostics);
  EXPECT_THAT(diagnostics.to_string(), HasSubstr("in/s.lua:9: shape is 'cone'"));
  Diagnostics none;
  const Job job = parse_job("hyades: 1\ninclude: [in/s.lua]\n", "job.yaml", assets, none);
  EXPECT_EQ(none.to_string(), "");
  EXPECT_EQ(job.objects.size(), 1U);
}

}  // namespace
}  // namespace hyades::core
