// What one path did, for those who ask: --explain, --paths, --split, and the measuring programs.
#pragma once
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "common/path/path_story.h"

/// Part of a path's estimate: its class in Heckbert's notation, from light to eye, and how much.
/// S: a vertex with one possible direction (mirror, glass); D: any other.
struct Contribution {
    static constexpr size_t own_pixel = PathStory::own_pixel;

    std::string path_class;  // such as "LDSE"
    Rgb L;
    size_t pixel = own_pixel;  // that a path from a light has met
};

/// Where the path went, and the vertex that it came from (-1: the eye, -2: it is a light).
struct PathVertex {
    Vec3 p;
    int from;
};

class ClassFilter;

/// trace() tells a PathLog what it does. Unless someone listens, that costs one untaken branch.
class PathLog {
public:
    PathLog() = default;
    /// A log that listens. class_filter: a regular expression that the whole class of a path must
    /// match to count; empty: all count. story: is told each step. Throws UsageError when it is
    /// none.
    explicit PathLog(const std::string& class_filter, PathStory* story = nullptr);

    /// Forgets the path before.
    void start() {
        if (listening_) forget();
    }
    /// From here on the path is another one that begins at p, a point of a light.
    void start_at_light(Vec3 p) {
        if (listening_) note_start_at_light(p);
    }
    /// From here on it is one that begins at the eye, as after start().
    void start_at_eye() {
        if (listening_) note_start_at_eye();
    }
    /// The path met x.
    void vertex(const Hit& x) {
        if (listening_) note_vertex(x);
    }
    /// The path leaves its last vertex along wi with throughput beta.
    void scatter(Vec3 wi, Rgb f, float pdf_w, bool specular, Rgb beta) {
        if (listening_) note_scatter(wi, f, pdf_w, specular, beta);
    }
    /// The path was allowed to go on with probability q, and beta divided by it.
    void roulette(float q, Rgb beta) {
        if (listening_) note_roulette(q, beta);
    }
    /// Goes back to the vertex before, whose other branch comes next (chapter 05 walks a tree).
    void step_back() {
        if (listening_) note_step_back();
    }
    /// The depth limit ended a path that could have gone on.
    void cut() {
        paths_cut_++;
        if (listening_) note_cut();
    }

    /// Emission found by following the path: returns what of it counts.
    Rgb emitted(Rgb contribution, float mis_b = 1) {
        return listening_ ? note_emitted(contribution, mis_b) : contribution;
    }
    /// A light sampled from the last vertex, with the density of either strategy (sr^-1): returns
    /// what of it counts.
    Rgb direct(Rgb contribution, Vec3 wi, float pdf_l, float pdf_b, float mis_l = 1) {
        return listening_ ? note_direct(contribution, wi, pdf_l, pdf_b, mis_l) : contribution;
    }

    /// The first s vertices from the light joined with the first t from the eye, of which the light
    /// and the eye are one each: returns what of it counts. s = 0: the t-th is the light. t = 1: in
    /// the pixel that the eye sees.
    Rgb joined(Rgb contribution, int s, int t, float mis = 1,
               size_t pixel = Contribution::own_pixel) {
        return listening_ ? note_joined(contribution, s, t, mis, pixel) : contribution;
    }

    /// Light that was stored at the last vertex, after so many scattering events, that one
    /// included; bit i of `mirrors`: event number i was at a mirror or glass, as far as that is
    /// known: of the first 8. Returns what of it counts.
    Rgb gathered(Rgb contribution, uint32_t depth, uint32_t mirrors) {
        return listening_ ? note_gathered(contribution, depth, mirrors) : contribution;
    }

    bool listening() const { return listening_; }
    const std::vector<Contribution>& contributions() const { return contributions_; }
    const std::vector<PathVertex>& vertices() const { return vertices_; }
    uint64_t paths_cut() const { return paths_cut_; }

private:
    void forget();
    void note_start_at_light(Vec3);
    void note_start_at_eye();
    void note_vertex(const Hit&);
    void note_scatter(Vec3, Rgb, float, bool, Rgb);
    void note_roulette(float, Rgb);
    void note_step_back();
    void note_cut();
    Rgb note_emitted(Rgb, float);
    Rgb note_direct(Rgb, Vec3, float, float, float);
    Rgb note_joined(Rgb, int, int, float, size_t);
    Rgb note_gathered(Rgb, uint32_t, uint32_t);
    Rgb keep(const PathStory::Addition& added);
    int current_vertex() const;
    int eye_vertex(size_t events) const;
    bool counts(const std::string& path_class);

    bool listening_ = false;
    PathStory* story_ = nullptr;
    uint64_t paths_cut_ = 0;
    std::string scattered_;   // D and S of the vertices left so far, the first one last
    std::string from_light_;  // of those of the path from the light, the first one first
    bool at_light_ = false;   // that is the one that goes on
    std::vector<PathVertex> vertices_;
    std::vector<int> latest_;  // vertex for each number of scatterings before it
    std::vector<Contribution> contributions_;
    std::shared_ptr<const ClassFilter> filter_;
    std::vector<std::pair<std::string, bool>> known_classes_;  // what the filter said of them
};
