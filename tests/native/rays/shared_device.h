// What the tests of ray tracers share: one context for the process.
#pragma once

#include "rays/tracers.h"
#include "rays/tracing_device.h"

#include <gtest/gtest.h>

namespace panoptes::test {

// Made when it is first asked for; its programs stay compiled from test to test.
TracingDevice& tracing_device();
void close_tracing_device();

}  // namespace panoptes::test
