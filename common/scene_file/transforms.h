// The directives of a pbrt-v4 scene file that move the current transform.
#pragma once
#include "common/geometry/transform.h"
#include "common/scene_file/lexer.h"

/// What one directive does: multiply the current transform from the right, or replace it.
struct TransformStep {
    Transform transform;
    bool replaces = false;
};

/// Reads the numbers after Identity, Translate, Scale, Rotate, LookAt, Transform or
/// ConcatTransform.
TransformStep read_transform(Lexer& lexer, const Token& directive);

/// The current transform after the step; throws at the position when it has no inverse, or when
/// its numbers are beyond all use.
Transform apply(const TransformStep& step, const Transform& current, const Position& at);
