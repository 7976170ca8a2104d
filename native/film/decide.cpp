#include "film/decide.h"

#include <algorithm>
#include <cctype>

namespace panoptes::film {

plan::Effects decide(const PassSet& wanted) {
  plan::Effects effects;
  const PassSet needed = with_divisors(wanted);
  for (int i = 0; i < kPassCount; ++i) {
    std::string name = "pass_" + std::string(kPasses[size_t(i)].name);
    std::transform(name.begin(), name.end(), name.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    const char* reason = wanted[size_t(i)]    ? "asked for"
                         : needed[size_t(i)] ? "another pass is divided by it"
                                             : "not enabled in the view layer";
    effects.push_back({name, needed[size_t(i)], reason});
  }
  return effects;
}

}  // namespace panoptes::film
