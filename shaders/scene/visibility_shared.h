// Which rays may meet an instance: the bits of scene::Instance::visibility, as Blender's ray
// visibility has them.
#pragma once

#include "base/cpp_glsl.h"

SHARED_BEGIN

const uint SEEN_BY_CAMERA = 1u;
const uint SEEN_BY_DIFFUSE = 2u;
const uint SEEN_BY_GLOSSY = 4u;
const uint SEEN_BY_TRANSMISSION = 8u;
const uint SEEN_BY_VOLUME_SCATTER = 16u;
const uint SEEN_BY_SHADOW = 32u;
const uint SEEN_BY_ALL = 63u;
// By what light of a surface is carried on: an emitter that none of these meets lights nothing.
const uint SEEN_BY_SCATTERED = SEEN_BY_DIFFUSE | SEEN_BY_GLOSSY | SEEN_BY_TRANSMISSION;

SHARED_END
