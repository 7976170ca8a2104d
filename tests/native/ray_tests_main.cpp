// Runs the tests of ray tracers, and ends the context that they share before the driver unloads.
#include "rays/shared_device.h"

namespace panoptes::test {

namespace {
std::unique_ptr<TracingDevice> the_device;
}

TracingDevice& tracing_device() {
  if (!the_device) the_device = std::make_unique<TracingDevice>();
  return *the_device;
}

void close_tracing_device() { the_device.reset(); }

}  // namespace panoptes::test

int main(int count, char** words) {
  ::testing::InitGoogleTest(&count, words);
  const int status = RUN_ALL_TESTS();
  panoptes::test::close_tracing_device();
  return status;
}
