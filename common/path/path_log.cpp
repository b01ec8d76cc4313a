#include "common/path/path_log.h"

#include "common/path/class_filter.h"

PathLog::PathLog(const std::string& class_filter, PathStory* story)
    : listening_(true), story_(story) {
    if (!class_filter.empty()) filter_ = std::make_shared<const ClassFilter>(class_filter);
}

void PathLog::forget() {
    scattered_.clear();
    from_light_.clear();
    at_light_ = false;
    vertices_.clear();
    latest_.clear();
    contributions_.clear();
}

void PathLog::note_start_at_light(Vec3 p) {
    from_light_.clear();
    at_light_ = true;
    vertices_.push_back({p, -2});
    if (story_) story_->starts_at_light(p, vertices_.size());
}

void PathLog::note_start_at_eye() {
    at_light_ = false;
    if (story_) story_->starts_at_eye();
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
    if (story_) story_->meets(x, vertices_.size());
}

/// The number, from 1, of the vertex that the path from the eye has come to; 0: none.
int PathLog::current_vertex() const { return eye_vertex(scattered_.size()); }

/// The same after so many scattering events; the last one there is, if the sky lies behind it.
int PathLog::eye_vertex(size_t events) const {
    size_t depth = std::min(events + 1, latest_.size());
    return depth == 0 ? 0 : latest_[depth - 1] + 1;
}

void PathLog::note_scatter(Vec3 wi, Rgb f, float pdf_w, bool specular, Rgb beta) {
    std::string& scattered = at_light_ ? from_light_ : scattered_;
    scattered.insert(at_light_ ? scattered.end() : scattered.begin(), specular ? 'S' : 'D');
    if (story_) story_->goes_on(wi, f, pdf_w, specular, beta);
}

void PathLog::note_roulette(float q, Rgb beta) {
    if (story_) story_->survives(q, beta);
}

void PathLog::note_step_back() {
    scattered_.erase(scattered_.begin());
    if (story_) story_->steps_back(current_vertex());
}

void PathLog::note_cut() {
    if (story_) story_->is_cut();
}

Rgb PathLog::note_emitted(Rgb contribution, float mis_b) {
    if (is_black(contribution)) return contribution;
    bool sky = story_ && story_->has_left();
    return keep({current_vertex(), sky ? "sky met" : "light met", "L" + scattered_ + "E", mis_b,
                 contribution});
}

Rgb PathLog::note_direct(Rgb contribution, Vec3 wi, float pdf_l, float pdf_b, float mis_l) {
    if (is_black(contribution)) return contribution;
    if (story_) story_->aims(wi, pdf_l, pdf_b);
    return keep({current_vertex(), "light aimed at", "LD" + scattered_ + "E", mis_l, contribution});
}

Rgb PathLog::note_joined(Rgb contribution, int s, int t, float mis, size_t pixel) {
    if (is_black(contribution)) return contribution;
    // A vertex where both ends are joined scatters light in many directions: D.
    size_t before = static_cast<size_t>(std::max(s - 2, 0));
    size_t after = static_cast<size_t>(std::max(t - 2, 0));
    std::string path_class = "L";
    path_class += from_light_.substr(0, before);
    if (s > 0) path_class.append(static_cast<size_t>(s > 1) + static_cast<size_t>(t > 1), 'D');
    path_class += scattered_.substr(scattered_.size() - after) + "E";
    std::string way = "s " + std::to_string(s) + ", t " + std::to_string(t);
    return keep({t == 1 ? s : eye_vertex(after), way, path_class, mis, contribution, pixel});
}

Rgb PathLog::note_gathered(Rgb contribution, uint32_t depth, uint32_t mirrors) {
    if (is_black(contribution)) return contribution;
    std::string path_class = "L";
    for (uint32_t i = 0; i + 1 < depth; i++) {
        path_class += i < 8 && (mirrors >> i & 1) != 0 ? 'S' : 'D';
    }
    path_class += "D" + scattered_ + "E";
    return keep({current_vertex(), "photons", path_class, 1, contribution});
}

Rgb PathLog::keep(const PathStory::Addition& added) {
    if (!counts(added.path_class)) return {};
    contributions_.push_back({added.path_class, added.L, added.pixel});
    if (story_) story_->adds(added);
    return added.L;
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
