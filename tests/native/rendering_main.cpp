// Runs the rendering tests, and ends the engine that they share before the driver unloads.
#include "support.h"

int main(int count, char** words) {
  ::testing::InitGoogleTest(&count, words);
  const int status = RUN_ALL_TESTS();
  panoptes::test::close_shared_engine();
  return status;
}
