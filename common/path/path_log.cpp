#include "common/path/path_log.h"

#include <cstdio>

#include "common/path/class_filter.h"

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

PathLog::PathLog(const std::string& class_filter, bool keep_steps)
    : listening_(true), keep_steps_(keep_steps) {
    if (!class_filter.empty()) filter_ = std::make_shared<const ClassFilter>(class_filter);
}

void PathLog::forget() {
    scattered_.clear();
    steps_.clear();
    vertices_.clear();
    latest_.clear();
    contributions_.clear();
}

void PathLog::note_vertex(const Hit& x) {
    size_t depth = scattered_.size();
    latest_.resize(depth + 1);
    latest_[depth] = static_cast<int>(vertices_.size());
    vertices_.push_back({x.p, depth > 0 ? latest_[depth - 1] : -1});
    if (!keep_steps_) return;
    steps_ += format("vertex %zu  %s at ", vertices_.size(), name(x.material->type)) +
              to_text(x.p) + ", n " + to_text(x.n) +
              format(", %s, distance %.6g\n", x.front ? "front" : "back", double{x.t});
}

void PathLog::note_scatter(Vec3 wi, Rgb f, float pdf_w, bool specular, Rgb beta) {
    scattered_.insert(scattered_.begin(), specular ? 'S' : 'D');
    if (!keep_steps_) return;
    steps_ +=
        "    goes on along wi " + to_text(wi) + ": f " + to_text(f) +
        format(" sr^-1, pdf_w %.6g%s, beta ", double{pdf_w}, specular ? " (delta)" : " sr^-1") +
        to_text(beta) + "\n";
}

void PathLog::note_roulette(float q, Rgb beta) {
    if (keep_steps_)
        steps_ += format("    survives roulette, q %.6g, beta ", double{q}) + to_text(beta) + "\n";
}

void PathLog::note_step_back() {
    scattered_.erase(scattered_.begin());
    if (keep_steps_)
        steps_ += format("    steps back to the vertex after %zu scatterings\n", scattered_.size());
}

Rgb PathLog::note_emitted(Rgb contribution, float mis_b) {
    if (is_black(contribution)) return contribution;
    std::string path_class = "L" + scattered_ + "E";
    if (keep_steps_) {
        steps_ += "    finds light: adds " + to_text(contribution) +
                  format(", mis_b %.6g, class ", double{mis_b}) + path_class + "\n";
    }
    return keep(path_class, contribution);
}

Rgb PathLog::note_direct(Rgb contribution, Vec3 wi, float pdf_l, float pdf_b, float mis_l) {
    if (is_black(contribution)) return contribution;
    std::string path_class = "LD" + scattered_ + "E";
    if (keep_steps_) {
        steps_ += "    light along wi " + to_text(wi) +
                  format(": pdf_l %.6g, pdf_b %.6g sr^-1, mis_l %.6g, adds ", double{pdf_l},
                         double{pdf_b}, double{mis_l}) +
                  to_text(contribution) + ", class " + path_class + "\n";
    }
    return keep(path_class, contribution);
}

Rgb PathLog::keep(const std::string& path_class, Rgb contribution) {
    if (!counts(path_class)) return {};
    contributions_.push_back({path_class, contribution});
    return contribution;
}

bool PathLog::counts(const std::string& path_class) {
    if (!filter_) return true;
    for (const auto& [known, counted] : known_classes_) {
        if (known == path_class) return counted;
    }
    bool counted = filter_->matches(path_class);
    if (known_classes_.size() < 1000) known_classes_.emplace_back(path_class, counted);
    return counted;
}
