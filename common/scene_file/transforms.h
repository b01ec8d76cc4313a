// The directives of a pbrt-v4 scene file that move the current transform.
#pragma once
#include "common/geometry/transform.h"
#include "common/scene_file/lexer.h"

/// What one directive does: multiply the current transform from the right, or replace it.
struct TransformStep {
    Transform transform;
    bool replaces = false;
    bool projects = false;  // a matrix whose last row is not 0 0 0 1; `transform` is without it
};

/// Reads the numbers after Identity, Translate, Scale, Rotate, LookAt, Transform or
/// ConcatTransform.
TransformStep read_transform(Lexer& lexer, const Token& directive);

/// Why nothing can stand where a step leads to; empty where something can. It is an error only if
/// something stands there.
std::string what_is_wrong_with(const TransformStep& step, const Transform& after);
