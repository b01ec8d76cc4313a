// Records what one path did, for --explain, --paths, --split and the measuring programs.
#pragma once
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/base/vec.h"
#include "common/material/hit.h"

/// The contribution of a path from a light to the pixel in which the camera sees it.
struct Splat {
    size_t pixel;
    Rgb L;
};
using Splats = std::vector<Splat>;

/// Part of a sample: the class of its path in Heckbert's notation, from light to eye, and how much.
/// S: a vertex with one possible direction (mirror, glass); D: any other.
struct Contribution {
    static constexpr size_t own_pixel = SIZE_MAX;

    std::string path_class;    // such as "LDSE"
    Rgb L;                     // weighted, W m^-2 sr^-1
    size_t pixel = own_pixel;  // or the one in which the camera sees a path from a light
    int vertex = 0;            // number of the last one on the way; 0: none
    std::string way = {};      // how the light was found
    float mis = 1;
};

/// A vertex of the path, and the number of the vertex before it (-1: the eye, -2: it is a light).
struct PathVertex {
    Vec3 p;
    int from;
};

/// What a Recorder knows of its path.
struct RecordedPath {
    size_t depth_ = 0;        // scattering events before the vertex that the path is at
    std::string scattered_;   // D and S of all vertices left, the first one last
    std::vector<Rgb> beta_;   // behind each of them, the first one first
    std::string from_light_;  // D and S of the path from the light, the first one first
    bool at_light_ = false;   // events belong to the path from the light
    std::vector<PathVertex> vertices_;
    std::vector<int> latest_;             // vertex for each number of scatterings before it
    std::map<std::string, Rgb> photons_;  // flux by the D and S of their paths
    std::vector<Contribution> contributions_;
};

/// The steps of one path in words, for --explain. Of the rays that this thread keeps (rays_kept) it
/// tells which shadow rays were blocked, and why the path ends. Chapter 05 has its own intersection
/// code: without rays the story cannot tell how the path ends.
struct PathStory {
    int max_depth;
    bool gathers;  // a path may end by gathering photons, as in chapter 23
    std::string text = {};
    std::string if_last = {};  // why the path ends, if no other step follows; empty: unknown
    size_t told = 0;           // rays described so far

    /// Adds a line, after those about the rays traced before it.
    void add(const std::string& line);
    /// The same for a step of the path. why: it ends, if no other step follows; empty: unknown.
    void step(const std::string& line, const std::string& why = "") {
        add(line);
        if_last = why;
    }
    /// Adds the reason why the path ended.
    void ends();
};

/// Receives the events of a path from trace(), which never reads from it: trace() returns the same
/// value whether or not the recorder stores anything. One that stores nothing costs an untaken
/// branch for each event.
///
/// It keeps track of the throughput beta itself, so events report radiance at the vertex, without
/// beta.      tested by  "identity: recording never changes an estimate"
class Recorder : RecordedPath {
public:
    /// keeps_all: stores all contributions and vertices, else only counts. story: receives each
    /// step.
    explicit Recorder(bool keeps_all = false, PathStory* story = nullptr)
        : listening_(keeps_all), story_(story) {}

    /// Starts a new path from the eye; the path before is deleted.
    void start() {
        if (listening_) static_cast<RecordedPath&>(*this) = {};
    }
    /// The next events belong to a path that starts at p, a point of a light.
    void start_at_light(Vec3 p) {
        if (listening_) note_start_at_light(p);
    }
    /// The next events belong to a path that starts at the eye, as after start().
    void start_at_eye() {
        if (listening_) note_start_at_eye();
    }
    /// The path hit x, or left the scene.
    void vertex(const std::optional<Hit>& x) {
        if (listening_ && x) note_vertex(*x);
    }
    /// The path leaves its last vertex along wi, with throughput beta.
    void scatter(Vec3 wi, Rgb f, float pdf_w, bool specular, Rgb beta) {
        if (listening_) note_scatter(wi, f, pdf_w, specular, beta);
    }
    template <class BsdfSample>
    void scatter(const BsdfSample& s, Rgb beta) {
        scatter(s.wi, s.f, s.pdf_w, s.specular, beta);
    }
    /// The path survived roulette with probability q, and beta was divided by q.
    void roulette(float q, Rgb beta) {
        if (listening_) note_roulette(q, beta);
    }
    /// Goes back to the vertex before, to follow its other branch (chapter 05 traces a tree).
    void step_back() {
        if (listening_) note_step_back();
    }
    /// Goes back to the t-th vertex from the eye (the pinhole is the first), where the next branch
    /// of the path starts.
    void back_to(int t) {
        while (listening_ && depth_ + 2 > static_cast<size_t>(t)) note_step_back();
    }
    /// The depth limit ended a path that could have gone on.
    void cut() {
        paths_cut_++;
        if (listening_) note_cut();
    }

    /// The path hit emission Le: beta Le mis_b was added.
    void emitted(Rgb Le, float mis_b = 1) {
        if (listening_) note_emitted(Le, mis_b);
    }
    /// A light was sampled from the last vertex, with these densities (sr^-1): beta Ld was added.
    void direct(Rgb Ld, Vec3 wi, float pdf_l, float pdf_b, float mis_l = 1) {
        if (listening_) note_direct(Ld, wi, pdf_l, pdf_b, mis_l);
    }
    /// The first s vertices from the light (included) were connected to the first t from the eye:
    /// L was added with weight mis. s = 0: the t-th is the light. t = 1: L was added to `pixel`.
    void connected(Rgb L, int s, int t, float mis = 1, size_t pixel = Contribution::own_pixel) {
        if (listening_) note_connected(L, s, t, mis, pixel);
    }
    /// The last vertex of the path from a light was connected to the camera.
    void splat(Rgb L, size_t pixel) {
        connected(L, static_cast<int>(vertices_.size()), 1, 1, pixel);
    }
    /// A photon near the last vertex contributes this flux. q: the square of its distance, divided
    /// by that of the radius. Its path from the light is the last photon.depth vertices up to
    /// number photon.vertex.
    template <class Vertices, class Photon>
    void photon(Rgb flux, float q, const Vertices& vertices, const Photon& photon) {
        gathered_++;
        inner_ += q < 0.5f;
        if (!listening_) return;
        std::string events;
        for (size_t i = static_cast<size_t>(photon.depth); i-- > 0;)
            events += is_specular(*vertices[photon.vertex - i].material) ? 'S' : 'D';
        photons_[events] += flux;
    }
    /// beta scale times the flux of those photons was added.
    void gathered(Rgb scale) {
        if (listening_) note_gathered(scale);
    }

    const std::vector<Contribution>& contributions() const { return contributions_; }
    const std::vector<PathVertex>& vertices() const { return vertices_; }
    uint64_t paths_cut() const { return paths_cut_; }
    /// The number of photons, and of those in the inner half of the area of their disk.
    uint64_t photons() const { return gathered_; }
    uint64_t inner_photons() const { return inner_; }

private:
    void note_start_at_light(Vec3);
    void note_start_at_eye();
    void note_vertex(const Hit&);
    void note_scatter(Vec3, Rgb, float, bool, Rgb);
    void note_roulette(float, Rgb);
    void note_step_back();
    void note_cut();
    void note_emitted(Rgb, float);
    void note_direct(Rgb, Vec3, float, float, float);
    void note_connected(Rgb, int, int, float, size_t);
    void note_gathered(Rgb);
    void keep(const Contribution&);
    Rgb beta() const { return depth_ == 0 ? Rgb{1, 1, 1} : beta_[depth_ - 1]; }
    /// The class of a path that begins with these letters and ends with the first events of the
    /// path from the eye.
    std::string class_of(std::string path_class, size_t events) const;
    int eye_vertex(size_t events) const;

    bool listening_;
    PathStory* story_;
    uint64_t paths_cut_ = 0, gathered_ = 0, inner_ = 0;
};
