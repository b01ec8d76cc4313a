// One path in words, for --explain.
#pragma once
#include <string>
#include <vector>

#include "common/scene/intersect.h"

/// The steps of one path as its Recorder tells them, which shadow rays were blocked, and why the
/// path ends.
///
/// It sees all rays that this thread traces until ends(). Without them (chapter 05 has its own
/// intersection code) it cannot tell how the path ends.
struct PathStory {
    /// gathers: a path may end by gathering photons, as in chapter 23.
    PathStory(int deepest, bool gathers_photons) : max_depth(deepest), gathers(gathers_photons) {
        rays_kept = &rays;
    }
    ~PathStory() {
        if (rays_kept == &rays) rays_kept = nullptr;
    }
    PathStory(const PathStory&) = delete;
    PathStory& operator=(const PathStory&) = delete;

    /// Adds a line, after those about the rays traced before it.
    void add(const std::string& line);
    /// The same for a step of the path. why: it ends, if no other step follows; empty: unknown.
    void step(const std::string& line, const std::string& why = "") {
        add(line);
        if_last = why, is_cut = false;
    }
    void starts_at_eye();
    /// Adds the reason why the path ended.
    void ends();
    /// Whether the path's last ray left the scene.
    bool has_left() const { return !rays.empty() && !rays.back().shadow && !rays.back().met; }

    const int max_depth;
    const bool gathers;
    std::string text = {}, if_last = {};
    bool is_cut = false;  // by the depth limit
    std::vector<TracedRay> rays = {};
    size_t told = 0;  // rays described so far
};
