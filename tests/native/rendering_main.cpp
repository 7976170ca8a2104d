// Runs the rendering tests; the shared engine ends before the process does, on its own terms.
#include "support.h"

int main(int count, char** words) {
  ::testing::InitGoogleTest(&count, words);
  return RUN_ALL_TESTS();
}
