// All of the library.
#pragma once

#include "vkfv/error.hpp"
#include "vkfv/image.hpp"
#include "vkfv/scene.hpp"
#include "vkfv/topography.hpp"
