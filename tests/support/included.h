// What most test files include. g++ compiles it once, for all of them: see rules.mk.
#pragma once
#include <doctest/doctest.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "common/light/light_shapes.h"
#include "common/recording/class_filter.h"
#include "common/scene/camera.h"
#include "common/scene/prepare.h"
#include "common/scene_file/reader.h"
