// Describes one path in words, for --explain.
#pragma once
#include <string>
#include <vector>

#include "common/recording/recorder.h"
#include "common/scene/intersect.h"

/// Describes one path as its Recorder reports it: each step, what it adds, which shadow rays were
/// blocked, and why the path ends.
///
/// It sees all rays that this thread traces until ends(). Without them (chapter 05 has its own
/// intersection code) it cannot tell how the path ends.
class PathStory {
public:
    /// counts_photons: a path may end by gathering photons, as in chapter 23.
    PathStory(int max_depth, bool counts_photons);
    ~PathStory();
    PathStory(const PathStory&) = delete;
    PathStory& operator=(const PathStory&) = delete;

    void starts_at_light(Vec3 p, size_t number);
    void starts_at_eye();
    void meets(const Hit& x, size_t number);
    void goes_on(Vec3 wi, Rgb f, float pdf_w, bool specular, Rgb beta);
    void survives(float q, Rgb beta);
    void steps_back(int vertex);
    void is_cut();
    void samples_light(Vec3 wi, float pdf_l, float pdf_b);
    void adds(const Contribution& added);
    /// Adds the reason why the path ended.
    void ends();
    /// Adds that the path was not followed to its end.
    void is_given_up();

    const std::string& text() const { return text_; }
    const std::vector<TracedRay>& rays() const { return rays_; }
    /// Whether the path's last ray left the scene.
    bool has_left() const { return !rays_.empty() && !rays_.back().shadow && !rays_.back().met; }

private:
    enum class Last { start, vertex, goes_on, survived, left, cut };
    void tell_rays();
    std::string end_at_vertex() const;

    const int max_depth_;
    const bool counts_photons_;
    std::string text_;
    std::vector<TracedRay> rays_;
    size_t told_ = 0;  // rays described so far
    Last last_ = Last::start;
    bool from_light_ = false;
    int events_ = 0;  // surfaces hit on this path
    size_t vertex_ = 0;
    MaterialAt material_ = nullptr;  // of that vertex
};
