// Runs the rendering tests, and ends the engine that they share before the driver unloads.
#include "support.h"

#include <cstdlib>

int main(int count, char** words) {
  // Whatever the computer has: tests of OpenImageDenoise know what its stand-in does.
  setenv("PANOPTES_OIDN", PANOPTES_FAKE_OIDN, 1);
  ::testing::InitGoogleTest(&count, words);
  const int status = RUN_ALL_TESTS();
  panoptes::test::close_shared_engine();
  return status;
}
