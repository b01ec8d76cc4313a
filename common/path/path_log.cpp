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
    from_light_.clear();
    at_light_ = false;
    steps_.clear();
    vertices_.clear();
    latest_.clear();
    contributions_.clear();
}

void PathLog::note_start_at_light(Vec3 p) {
    from_light_.clear();
    at_light_ = true;
    vertices_.push_back({p, -2});
    if (keep_steps_) {
        steps_ += format("vertex %zu  a light at ", vertices_.size()) + to_text(p) + "\n";
    }
}

void PathLog::note_start_at_eye() {
    at_light_ = false;
    if (keep_steps_) steps_ += "from the eye:\n";
}

void PathLog::note_vertex(const Hit& x) {
    if (at_light_) {
        vertices_.push_back({x.p, static_cast<int>(vertices_.size()) - 1});
    } else {
        size_t depth = scattered_.size();
        latest_.resize(depth + 1);
        latest_[depth] = static_cast<int>(vertices_.size());
        vertices_.push_back({x.p, depth > 0 ? latest_[depth - 1] : -1});
    }
    if (!keep_steps_) return;
    steps_ += format("vertex %zu  %s at ", vertices_.size(), name(x.material->type)) +
              to_text(x.p) + ", n " + to_text(x.n) +
              format(", %s, distance %.6g\n", x.front ? "front" : "back", double{x.t});
}

void PathLog::note_scatter(Vec3 wi, Rgb f, float pdf_w, bool specular, Rgb beta) {
    std::string& scattered = at_light_ ? from_light_ : scattered_;
    scattered.insert(at_light_ ? scattered.end() : scattered.begin(), specular ? 'S' : 'D');
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

Rgb PathLog::note_joined(Rgb contribution, int s, int t, float mis, size_t pixel) {
    if (is_black(contribution)) return contribution;
    // A vertex where both ends are joined scatters light in many directions: D.
    size_t before = static_cast<size_t>(std::max(s - 2, 0));
    size_t after = static_cast<size_t>(std::max(t - 2, 0));
    std::string path_class = "L";
    path_class += from_light_.substr(0, before);
    path_class.append(static_cast<size_t>(s > 1) + static_cast<size_t>(t > 1), 'D');
    path_class += scattered_.substr(scattered_.size() - after) + "E";
    if (keep_steps_) {
        steps_ += format("    %d vertices from the light and %d from the eye: ", s, t) +
                  (pixel == Contribution::own_pixel ? "" : format("pixel number %zu, ", pixel)) +
                  "adds " + to_text(contribution) + format(", mis %.6g, class ", double{mis}) +
                  path_class + "\n";
    }
    return keep(path_class, contribution, pixel);
}

Rgb PathLog::note_gathered(Rgb contribution, uint32_t depth, uint32_t mirrors) {
    if (is_black(contribution)) return contribution;
    std::string path_class = "L";
    for (uint32_t i = 0; i + 1 < depth; i++) {
        path_class += i < 8 && (mirrors >> i & 1) != 0 ? 'S' : 'D';
    }
    path_class += "D" + scattered_ + "E";
    if (keep_steps_) {
        steps_ += "    photons: add " + to_text(contribution) + ", class " + path_class + "\n";
    }
    return keep(path_class, contribution);
}

Rgb PathLog::keep(const std::string& path_class, Rgb contribution, size_t pixel) {
    if (!counts(path_class)) return {};
    contributions_.push_back({path_class, contribution, pixel});
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
