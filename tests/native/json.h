// A strict reader of JSON (RFC 8259), as far as the statistics need it.
#pragma once

#include <cctype>
#include <cstdlib>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

namespace panoptes::test {

struct Json {
  std::string text;  // of strings, and of true, false and null
  double number = 0;
  std::vector<Json> list;
  std::map<std::string, Json> object;
  const Json& at(const std::string& key) const { return object.at(key); }
};

// Throws std::runtime_error with the place of the first mistake.
class JsonReader {
 public:
  explicit JsonReader(const std::string& text) : text_(text) {}

  Json read() {
    const Json value = any();
    space();
    if (at_ != text_.size()) wrong("something follows the value");
    return value;
  }

 private:
  [[noreturn]] void wrong(const std::string& what) const {
    throw std::runtime_error("JSON, character " + std::to_string(at_) + ": " + what);
  }
  void space() {
    while (at_ < text_.size() && (text_[at_] == ' ' || text_[at_] == '\n')) ++at_;
  }
  bool take(char c) {
    space();
    if (at_ >= text_.size() || text_[at_] != c) return false;
    ++at_;
    return true;
  }
  void need(char c) {
    if (!take(c)) wrong(std::string("'") + c + "' expected");
  }

  Json any() {
    space();
    if (at_ >= text_.size()) wrong("a value expected");
    Json value;
    if (take('{')) {
      if (take('}')) return value;
      do {
        space();
        const std::string key = string();
        need(':');
        if (!value.object.emplace(key, any()).second) wrong("'" + key + "' is there twice");
      } while (take(','));
      need('}');
    } else if (take('[')) {
      if (take(']')) return value;
      do value.list.push_back(any());
      while (take(','));
      need(']');
    } else if (text_[at_] == '"') {
      value.text = string();
    } else if (text_[at_] == '-' || std::isdigit(static_cast<unsigned char>(text_[at_]))) {
      value.number = digits();
    } else {
      for (const char* word : {"true", "false", "null"})
        if (text_.compare(at_, std::string(word).size(), word) == 0) {
          value.text = word;
          at_ += value.text.size();
          return value;
        }
      wrong("no value");
    }
    return value;
  }

  double digits() {
    const size_t start = at_;
    const auto run = [&] {
      const size_t first = at_;
      while (at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_]))) ++at_;
      if (at_ == first) wrong("a digit expected");
    };
    if (text_[at_] == '-') ++at_;
    run();
    if (at_ < text_.size() && text_[at_] == '.') {
      ++at_;
      run();
    }
    if (at_ < text_.size() && (text_[at_] == 'e' || text_[at_] == 'E')) {
      ++at_;
      if (at_ < text_.size() && (text_[at_] == '+' || text_[at_] == '-')) ++at_;
      run();
    }
    return std::strtod(text_.c_str() + start, nullptr);
  }

  std::string string() {
    if (!take('"')) wrong("a string expected");
    std::string result;
    while (true) {
      if (at_ >= text_.size()) wrong("a string does not end");
      const char c = text_[at_++];
      if (c == '"') return result;
      if (static_cast<unsigned char>(c) < 0x20) wrong("a bare control character");
      if (c != '\\') {
        result += c;
        continue;
      }
      const char escaped = at_ < text_.size() ? text_[at_++] : '\0';
      if (escaped == 'u') {
        const long code = std::strtol(text_.substr(at_, 4).c_str(), nullptr, 16);
        if (code > 0x7f) wrong("only ASCII is escaped");
        result += char(code);
        at_ += 4;
      } else if (escaped == '"' || escaped == '\\' || escaped == '/') {
        result += escaped;
      } else if (escaped == 'n' || escaped == 't') {
        result += escaped == 'n' ? '\n' : '\t';
      } else {
        wrong("an unknown escape");
      }
    }
  }

  const std::string& text_;
  size_t at_ = 0;
};

inline Json parse_json(const std::string& text) { return JsonReader(text).read(); }

}  // namespace panoptes::test
