#include "common/recording/recorder.h"

#include "common/base/text.h"
#include "common/scene/intersect.h"

namespace {

std::string triple(float a, float b, float c) {
    return format("(%.6g, %.6g, %.6g)", double{a}, double{b}, double{c});
}
std::string to_text(Vec3 v) { return triple(v.x, v.y, v.z); }
std::string to_text(Rgb c) { return triple(c.r, c.g, c.b); }

constexpr const char* material_names[] = {"diffuse", "conductor", "dielectric"};

std::string depth_limit(const PathStory& story) {
    return format("the depth limit, %d scattering events", story.max_depth);
}

/// Why a path ends at a vertex, where no next direction was sampled.
std::string end_at_vertex(const PathStory& story, const Hit& x, size_t number) {
    std::string vertex = format("vertex %zu", number);
    bool diffuse = x.material->type == MaterialType::diffuse;
    if (diffuse && is_black(x.material->reflectance)) return vertex + " is black: it absorbs all";
    if (diffuse && story.gathers) return "photons around " + vertex + " tell the rest";
    return "absorbed at " + vertex + ": the direction drawn lies below the surface";
}

}  // namespace

void PathStory::add(const std::string& line) {
    for (; told < rays_kept->size(); told++) {
        const TracedRay& traced = (*rays_kept)[told];
        if (traced.shadow && traced.met) {
            text += "    shadow ray along " + to_text(traced.ray.d) + ": blocked\n";
        } else if (!traced.shadow && !traced.met) {
            text += "    leaves the scene along " + to_text(traced.ray.d) + "\n";
            if_last = "it has left the scene";
        }
    }
    text += line;
}

void PathStory::ends() {
    add("");
    if (!rays_kept->empty() && !if_last.empty()) text += "    ends: " + if_last + "\n";
}

void Recorder::note_start_at_light(Vec3 p) {
    from_light_.clear();
    at_light_ = true;
    vertices_.push_back({p, -2});
    if (story_)
        story_->step(format("vertex %zu  a light at ", vertices_.size()) + to_text(p) + "\n");
}

void Recorder::note_start_at_eye() {
    at_light_ = false;
    if (!story_) return;
    story_->ends();
    story_->step("from the eye:\n");
}

void Recorder::note_vertex(const Hit& x) {
    int number = static_cast<int>(vertices_.size()), before = number - 1;
    if (!at_light_) {
        latest_.resize(depth_ + 1);
        latest_[depth_] = number;
        before = depth_ > 0 ? latest_[depth_ - 1] : -1;
    }
    vertices_.push_back({x.p, before});
    if (!story_) return;
    size_t shown = vertices_.size(), limit = static_cast<size_t>(story_->max_depth);
    bool at_limit = at_light_ && from_light_.size() + 1 == limit;
    story_->step(
        format("vertex %zu  %s at ", shown, material_names[static_cast<int>(x.material->type)]) +
            to_text(x.p) + ", n " + to_text(x.n) +
            format(", %s, distance %.6g\n", x.front ? "front" : "back", double{x.t}),
        at_limit ? depth_limit(*story_) : end_at_vertex(*story_, x, shown));
}

/// The number, from 1, of the vertex after this many scattering events; the last one, if the sky
/// follows it; 0: none.
int Recorder::eye_vertex(size_t events) const {
    size_t depth = std::min(events + 1, latest_.size());
    return depth == 0 ? 0 : latest_[depth - 1] + 1;
}

void Recorder::note_scatter(Vec3 wi, Rgb f, float pdf_w, bool specular, Rgb beta) {
    if (at_light_) {
        from_light_ += specular ? 'S' : 'D';
    } else {
        scattered_.erase(0, scattered_.size() - depth_);
        scattered_.insert(scattered_.begin(), specular ? 'S' : 'D');
        beta_.resize(depth_++);
        beta_.push_back(beta);
    }
    if (!story_) return;
    story_->step(
        "    goes on along wi " + to_text(wi) + ": f " + to_text(f) +
            format(" sr^-1, pdf_w %.6g%s, beta ", double{pdf_w}, specular ? " (delta)" : " sr^-1") +
            to_text(beta) + "\n",
        "roulette stops it");
}

void Recorder::note_roulette(float q, Rgb beta) {
    if (!at_light_) beta_[depth_ - 1] = beta;
    if (!story_) return;
    std::string line = format("    survives roulette, q %.6g, beta ", double{q}) + to_text(beta);
    story_->step(q < 1 ? line + "\n" : "");
}

void Recorder::note_step_back() {
    depth_--;
    if (story_) story_->step(format("    steps back to vertex %d\n", eye_vertex(depth_)));
}

void Recorder::note_cut() {
    if (story_) story_->step("    ends: " + depth_limit(*story_) + "\n");
}

std::string Recorder::class_of(std::string path_class, size_t events) const {
    path_class.append(scattered_, scattered_.size() - events);
    return path_class += 'E';
}

void Recorder::note_emitted(Rgb Le, float mis_b) {
    bool sky = story_ && !rays_kept->empty() && !rays_kept->back().met && !rays_kept->back().shadow;
    keep({class_of("L", depth_), beta() * Le * mis_b, Contribution::own_pixel, eye_vertex(depth_),
          sky ? "sky met" : "light met", mis_b});
}

void Recorder::note_direct(Rgb Ld, Vec3 wi, float pdf_l, float pdf_b, float mis_l) {
    if (is_black(Ld)) return;
    if (story_)
        story_->add("    samples a light along wi " + to_text(wi) +
                    format(": pdf_l %.6g, pdf_b %.6g sr^-1\n", double{pdf_l}, double{pdf_b}));
    keep({class_of("LD", depth_), beta() * Ld, Contribution::own_pixel, eye_vertex(depth_),
          "light sampled", mis_l});
}

void Recorder::note_connected(Rgb L, int s, int t, float mis, size_t pixel) {
    // A vertex where both ends are connected scatters light in many directions: D.
    size_t before = static_cast<size_t>(std::max(s - 2, 0));
    size_t after = static_cast<size_t>(std::max(t - 2, 0));
    std::string path_class = "L";
    path_class += from_light_.substr(0, before);
    if (s > 0) path_class.append(static_cast<size_t>(s > 1) + static_cast<size_t>(t > 1), 'D');
    path_class = class_of(std::move(path_class), after);
    std::string way = "s " + std::to_string(s) + ", t " + std::to_string(t);
    keep({path_class, L, pixel, t == 1 ? s : eye_vertex(after), way, mis});
}

void Recorder::note_gathered(Rgb scale) {
    for (const auto& [events, flux] : photons_) {
        keep({class_of("L" + events, depth_), beta() * (scale * flux), Contribution::own_pixel,
              eye_vertex(depth_), "photons"});
    }
    photons_.clear();
}

void Recorder::keep(const Contribution& added) {
    if (is_black(added.L)) return;
    contributions_.push_back(added);
    if (story_)
        story_->add("    " + added.way + ": adds " + to_text(added.L) +
                    format(", mis %.6g, class ", double{added.mis}) + added.path_class + "\n");
}
