#include "common/recording/path_story.h"

#include <cstdio>

namespace {

template <typename... Args>
std::string format(const char* pattern, Args... args) {
    char text[512];
    std::snprintf(text, sizeof text, pattern, args...);
    return text;
}

std::string to_text(Vec3 v) {
    return format("(%.6g, %.6g, %.6g)", double{v.x}, double{v.y}, double{v.z});
}
std::string to_text(Rgb c) {
    return format("(%.6g, %.6g, %.6g)", double{c.r}, double{c.g}, double{c.b});
}

const char* name(MaterialType type) {
    switch (type) {
        case MaterialType::diffuse: return "diffuse";
        case MaterialType::conductor: return "conductor";
        case MaterialType::dielectric: return "dielectric";
    }
    return "";
}

}  // namespace

PathStory::PathStory(int max_depth, bool counts_photons)
    : max_depth_(max_depth), counts_photons_(counts_photons) {
    rays_kept = &rays_;
}

PathStory::~PathStory() {
    if (rays_kept == &rays_) rays_kept = nullptr;
}

/// Describes the rays traced since the last step, except those that the next step describes.
void PathStory::tell_rays() {
    for (; told_ < rays_.size(); told_++) {
        const TracedRay& traced = rays_[told_];
        if (traced.shadow && traced.met) {
            text_ += "    shadow ray along " + to_text(traced.ray.d) + ": blocked\n";
        } else if (!traced.shadow && !traced.met) {
            text_ += "    leaves the scene along " + to_text(traced.ray.d) + "\n";
            last_ = Last::left;
        }
    }
}

void PathStory::starts_at_light(Vec3 p, size_t number) {
    tell_rays();
    text_ += format("vertex %zu  a light at ", number) + to_text(p) + "\n";
    last_ = Last::start, from_light_ = true, events_ = 0, vertex_ = number;
}

void PathStory::starts_at_eye() {
    ends();
    rays_kept = &rays_;
    text_ += "from the eye:\n";
    last_ = Last::start, from_light_ = false, events_ = 0;
}

void PathStory::meets(const Hit& x, size_t number) {
    tell_rays();
    last_ = Last::vertex, events_++, vertex_ = number, material_ = x.material;
    text_ += format("vertex %zu  %s at ", number, name(x.material->type)) + to_text(x.p) + ", n " +
             to_text(x.n) +
             format(", %s, distance %.6g\n", x.front ? "front" : "back", double{x.t});
}

void PathStory::goes_on(Vec3 wi, Rgb f, float pdf_w, bool specular, Rgb beta) {
    tell_rays();
    if (last_ == Last::cut) return;  // drawn, but not followed
    last_ = Last::goes_on;
    text_ +=
        "    goes on along wi " + to_text(wi) + ": f " + to_text(f) +
        format(" sr^-1, pdf_w %.6g%s, beta ", double{pdf_w}, specular ? " (delta)" : " sr^-1") +
        to_text(beta) + "\n";
}

void PathStory::survives(float q, Rgb beta) {
    if (last_ == Last::cut) return;
    last_ = Last::survived;
    if (q < 1)
        text_ += format("    survives roulette, q %.6g, beta ", double{q}) + to_text(beta) + "\n";
}

void PathStory::steps_back(int vertex) {
    tell_rays();
    last_ = Last::vertex;
    text_ += format("    steps back to vertex %d\n", vertex);
}

void PathStory::is_cut() {
    tell_rays();
    last_ = Last::cut;
    text_ += format("    ends: the depth limit, %d scattering events\n", max_depth_);
}

void PathStory::samples_light(Vec3 wi, float pdf_l, float pdf_b) {
    tell_rays();
    text_ += "    samples a light along wi " + to_text(wi) +
             format(": pdf_l %.6g, pdf_b %.6g sr^-1\n", double{pdf_l}, double{pdf_b});
}

void PathStory::adds(const Contribution& added) {
    tell_rays();
    text_ += "    " + added.way + ": adds " + to_text(added.L) +
             format(", mis %.6g, class ", double{added.mis}) + added.path_class + "\n";
}

/// Why the path ends at its last vertex, where no next direction was sampled.
std::string PathStory::end_at_vertex() const {
    std::string vertex = format("vertex %zu", vertex_);
    if (from_light_ && events_ == max_depth_)
        return format("the depth limit, %d scattering events", max_depth_);
    bool diffuse = material_->type == MaterialType::diffuse;
    if (diffuse && is_black(material_->reflectance)) return vertex + " is black: it absorbs all";
    if (diffuse && counts_photons_) return "photons around " + vertex + " tell the rest";
    return "absorbed at " + vertex + ": the direction drawn lies below the surface";
}

void PathStory::ends() {
    if (!rays_.empty()) {
        tell_rays();
        if (last_ == Last::left) text_ += "    ends: it has left the scene\n";
        if (last_ == Last::goes_on) text_ += "    ends: roulette stops it\n";
        if (last_ == Last::vertex) text_ += "    ends: " + end_at_vertex() + "\n";
    }
    rays_kept = nullptr;
}

void PathStory::is_given_up() {
    tell_rays();
    text_ += "    given up here: the path goes on, but the program was stopped\n";
    rays_kept = nullptr;
}
