// What one path did, for those who ask: --explain, --paths, --split, and the measuring programs.
#pragma once
#include <map>
#include <optional>

#include "common/recording/path_story.h"

/// Where the path went, and the vertex that it came from (-1: the eye, -2: it is a light).
struct PathVertex {
    Vec3 p;
    int from;
};

/// trace() reports to a Recorder what it does, and never asks it: what trace() returns is the same
/// whether or not the recorder keeps anything. One that keeps nothing costs an untaken branch for
/// each event.
///
/// Follows the throughput beta by itself, so that events tell what was found and not what of it
/// reaches the eye.      tested by  "identity: recording never changes an estimate"
class Recorder {
public:
    /// Keeps nothing but how many paths were cut.
    Recorder() = default;
    /// Keeps all contributions and vertices. story: is told each step.
    explicit Recorder(bool keeps_all, PathStory* story = nullptr)
        : listening_(keeps_all), story_(story) {}

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
    /// The path met x, or left the scene.
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
    /// Roulette let the path go on with probability q, and beta was divided by it.
    void roulette(float q, Rgb beta) {
        if (listening_) note_roulette(q, beta);
    }
    /// Goes back to the vertex before, whose other branch comes next (chapter 05 walks a tree).
    void step_back() {
        if (listening_) note_step_back();
    }
    /// Goes back to the t-th vertex from the eye, the pinhole being the first: the next branch of
    /// the path begins there.
    void back_to(int t) {
        if (listening_) note_back_to(t);
    }
    /// The depth limit ended a path that could have gone on.
    void cut() {
        paths_cut_++;
        if (listening_) note_cut();
    }

    /// The path met Le: beta Le mis_b was added.
    void emitted(Rgb Le, float mis_b = 1) {
        if (listening_) note_emitted(Le, mis_b);
    }
    /// A light was sampled from the last vertex, with these densities (sr^-1): beta Ld was added.
    void direct(Rgb Ld, Vec3 wi, float pdf_l, float pdf_b, float mis_l = 1) {
        if (listening_) note_direct(Ld, wi, pdf_l, pdf_b, mis_l);
    }
    /// The first s vertices from the light, itself included, were connected with the first t from
    /// the eye: L was added, with weight mis. s = 0: the t-th is the light. t = 1: in a pixel.
    void connected(Rgb L, int s, int t, float mis = 1, size_t pixel = Contribution::own_pixel) {
        if (listening_) note_connected(L, s, t, mis, pixel);
    }
    /// The last vertex of the path from a light was connected to the camera.
    void splat(Rgb L, size_t pixel) {
        connected(L, static_cast<int>(vertices_.size()), 1, 1, pixel);
    }
    /// A photon near the last vertex counts so much flux. paths.path_of(photon): its path, up to
    /// where it lies.
    template <class Paths, class Photon>
    void photon(Rgb flux, const Paths& paths, const Photon& photon) {
        if (!listening_) return;
        std::string events;
        for (const auto& x : paths.path_of(photon)) events += is_specular(*x.material) ? 'S' : 'D';
        photons_[events] += flux;
    }
    /// beta scale times the flux of those photons was added.
    void gathered(Rgb scale) {
        if (listening_) note_gathered(scale);
    }

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
    void note_back_to(int);
    void note_cut();
    void note_emitted(Rgb, float);
    void note_direct(Rgb, Vec3, float, float, float);
    void note_connected(Rgb, int, int, float, size_t);
    void note_gathered(Rgb);
    void keep(const Contribution&);
    Rgb beta() const { return beta_.empty() ? Rgb{1, 1, 1} : beta_.back(); }
    int current_vertex() const;
    int eye_vertex(size_t events) const;

    bool listening_ = false;
    PathStory* story_ = nullptr;
    uint64_t paths_cut_ = 0;
    std::string scattered_;   // D and S of the vertices left so far, the first one last
    std::vector<Rgb> beta_;   // behind each of them, the first one first
    std::string from_light_;  // D and S of the path from the light, the first one first
    bool at_light_ = false;   // that is the one that goes on
    std::vector<PathVertex> vertices_;
    std::vector<int> latest_;             // vertex for each number of scatterings before it
    std::map<std::string, Rgb> photons_;  // flux by the D and S of their paths
    std::vector<Contribution> contributions_;
};
