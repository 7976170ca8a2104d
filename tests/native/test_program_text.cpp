// How program text is put together, and how a driver's messages find back to it. No GL.
#include "base/error.h"
#include "gl/program.h"
#include "support.h"

#include <regex>
#include <sstream>

namespace panoptes::test {
namespace {

using gl::expand;
using gl::ExpandedSource;
using gl::ProgramSource;

ProgramSource source(std::map<std::string, std::string> files,
                     std::vector<std::string> defines = {}) {
  ProgramSource s;
  s.name = "test";
  s.stages = {{GL_COMPUTE_SHADER, "main.comp"}};
  s.defines = std::move(defines);
  s.snippets = std::move(files);
  return s;
}

std::vector<std::string> lines_of(const std::string& text) {
  std::vector<std::string> lines;
  std::istringstream stream(text);
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

int count(const std::string& text, const std::string& part) {
  int n = 0;
  for (size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + 1)) ++n;
  return n;
}

TEST(ProgramText, StartsWithTheVersionThenTheDefines) {
  const ExpandedSource e =
      expand(source({{"main.comp", "void main() {}"}}, {"A 1", "B 2"}), {0, "main.comp"});
  EXPECT_EQ(e.text.find("#version 450 core\n#define A 1\n#define B 2\n"), 0u) << e.text;
}

TEST(ProgramText, IncludesEachFileOnce) {
  const ProgramSource s = source({{"main.comp", "#include \"a\"\n#include \"b\"\n#include \"a\"\n"},
                                  {"a", "int only_a;\n#include \"b\"\n#include \"main.comp\"\n"},
                                  {"b", "int only_b;\n#include \"a\"\n"}});
  const ExpandedSource e = expand(s, {0, "main.comp"});
  EXPECT_EQ(count(e.text, "only_a"), 1);
  EXPECT_EQ(count(e.text, "only_b"), 1);
  EXPECT_EQ(e.files, (std::vector<std::string>{"main.comp", "a", "b"}));
  EXPECT_EQ(count(e.text, "#include"), 0);
}

// Follows the #line directives through a text: what a driver's message about each line is
// translated to must name the file and the line that the text came from, even where the driver
// forgets the file's number, as Mesa does.
void expect_lines_map(const ExpandedSource& e, const std::map<std::string, std::string>& files) {
  static const std::regex directive(R"(#line (\d+) (\d+))"), place(R"((.+):(\d+): x\n)");
  size_t number = 0;
  int checked = 0;
  for (const std::string& line : lines_of(e.text)) {
    std::smatch match;
    if (std::regex_match(line, match, directive)) {
      number = std::stoul(match[1]);
      continue;
    }
    if (number == 0) continue;  // the head, before the first directive
    const std::string message = gl::translate_log(fmt::format("0:{}(1): x", number++), e.files);
    ASSERT_TRUE(std::regex_match(message, match, place)) << message;
    const std::vector<std::string> original = lines_of(files.at(match[1]));
    const size_t index = std::stoul(match[2]) - 1;
    ASSERT_LT(index, original.size()) << message;
    const bool ours =
        original[index].find("#include") == 0 || original[index].find("#pragma once") == 0;
    if (ours && line.empty()) continue;
    ASSERT_EQ(line, original[index]) << message;
    ++checked;
  }
  EXPECT_GT(checked, 3);
}

TEST(ProgramText, LineDirectivesNameFileAndLine) {
  const std::map<std::string, std::string> files{
      {"main.comp", "// one\n#include \"a\"\n// three\n\n#include \"b\"\n// six\n"},
      {"a", "#pragma once\n// a two\n#include \"b\"\n// a four\n  #  include  \"c\"  \n// a six"},
      {"b", "// b one\n// b two\n"},
      {"c", "// c one\n"}};
  const ExpandedSource e = expand(source(files), {0, "main.comp"});
  expect_lines_map(e, files);
  EXPECT_EQ(count(e.text, "pragma"), 0);
}

TEST(ProgramText, EveryShaderOfTheSourcesMapsItsLines) {
  for (const char* name :
       {"rasterize/surfaces.comp", "rasterize/raster.vert", "rasterize/raster.frag",
        "realtime/direct_light.comp", "realtime/compose.comp", "radiance_cache/world_radiance.comp",
        "realtime/background.comp", "rasterize/bin_offsets.comp"}) {
    ProgramSource s;
    s.snippets["generated/material.glsl"] = "// one\n// two\n";
    s.snippets["generated/world.glsl"] = "// one\n// two\n";
    const ExpandedSource e = expand(s, {0, name});
    std::map<std::string, std::string> files(s.snippets);
    for (const std::string& file : e.files)
      if (!files.count(file)) files[file] = std::string(gl::embedded_shader(file));
    SCOPED_TRACE(name);
    expect_lines_map(e, files);
  }
}

TEST(ProgramText, AMissingIncludeNamesBothFiles) {
  const ProgramSource s = source({{"main.comp", "#include \"a\"\n"}, {"a", "#include \"gone\"\n"}});
  expect_error([&] { expand(s, {0, "main.comp"}); }, "'a' includes 'gone'");
  expect_error([&] { expand({}, {0, "no/such.comp"}); }, "'no/such.comp'");
}

TEST(ProgramText, GeneratedCodeMayBeAbsent) {
  // Includes are resolved before conditions: a permutation without generated code has none.
  const ProgramSource s =
      source({{"main.comp", "#if 0\n#include \"generated/material.glsl\"\n#endif\n// end\n"}});
  const ExpandedSource e = expand(s, {0, "main.comp"});
  EXPECT_EQ(count(e.text, "// end"), 1);
  EXPECT_EQ(e.files.size(), 1u);
}

TEST(ProgramText, AnEmptySnippetIsAFile) {
  const ProgramSource s = source({{"main.comp", "#include \"a\"\nint x;\n"}, {"a", ""}});
  EXPECT_EQ(expand(s, {0, "main.comp"}).files, (std::vector<std::string>{"main.comp", "a"}));
}

TEST(ProgramKey, DiffersInWhatMakesAProgram) {
  const ProgramSource base = source({{"generated/material.glsl", "a"}}, {"X 1", "Y 2"});
  std::set<std::string> keys{base.key()};
  ProgramSource other = base;
  other.name = "another name";
  EXPECT_EQ(other.key(), base.key());  // names are for messages
  other = base;
  other.defines[1] = "Y 3";
  keys.insert(other.key());
  other = base;
  other.defines.pop_back();
  keys.insert(other.key());
  other = base;
  other.snippets["generated/material.glsl"] = "b";
  keys.insert(other.key());
  other = base;
  other.stages[0].file = "other.comp";
  keys.insert(other.key());
  EXPECT_EQ(keys.size(), 5u);
}

TEST(TranslateLog, NamesFileAndLineOfEveryDriver) {
  const std::vector<std::string> files{"main.comp", "base/a.glsl"};
  // Mesa, NVIDIA, glslang.
  EXPECT_EQ(gl::translate_log("1:23(7): error: `foo' undeclared", files),
            "base/a.glsl:23: error: `foo' undeclared\n");
  EXPECT_EQ(gl::translate_log("0:4(10): error: syntax error, unexpected '}'\n", files),
            "main.comp:4: error: syntax error, unexpected '}'\n");
  EXPECT_EQ(gl::translate_log("1(23) : error C1503: undefined variable \"foo\"", files),
            "base/a.glsl:23: error C1503: undefined variable \"foo\"\n");
  EXPECT_EQ(gl::translate_log("ERROR: 1:23: 'foo' : undeclared identifier", files),
            "ERROR: base/a.glsl:23: 'foo' : undeclared identifier\n");
}

TEST(TranslateLog, SurvivesWhatItDoesNotKnow) {
  const std::vector<std::string> files{"main.comp"};
  EXPECT_EQ(gl::translate_log("", files), "");
  EXPECT_EQ(gl::translate_log("something went wrong", files), "something went wrong\n");
  EXPECT_NE(gl::translate_log("9:1(1): error", files).find("main.comp"), std::string::npos);
  EXPECT_NO_THROW(gl::translate_log("99999999999999999999:1(1): error", files));
}

TEST(TranslateLog, KeepsEveryLine) {
  EXPECT_EQ(gl::translate_log("0:1(1): error: a\nnote\n0:2(1): warning: b\n", {"m"}),
            "m:1: error: a\nnote\nm:2: warning: b\n");
}

}  // namespace
}  // namespace panoptes::test
