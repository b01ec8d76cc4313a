#include "common/recording/recorder.h"

#include "common/recording/path_story.h"

void Recorder::forget() {
    depth_ = 0;
    scattered_.clear();
    beta_.clear();
    from_light_.clear();
    at_light_ = false;
    vertices_.clear();
    latest_.clear();
    photons_.clear();
    contributions_.clear();
}

void Recorder::note_start_at_light(Vec3 p) {
    from_light_.clear();
    at_light_ = true;
    vertices_.push_back({p, -2});
    if (story_) story_->starts_at_light(p, vertices_.size());
}

void Recorder::note_start_at_eye() {
    at_light_ = false;
    if (story_) story_->starts_at_eye();
}

void Recorder::note_vertex(const Hit& x) {
    if (at_light_) {
        vertices_.push_back({x.p, static_cast<int>(vertices_.size()) - 1});
    } else {
        latest_.resize(depth_ + 1);
        latest_[depth_] = static_cast<int>(vertices_.size());
        vertices_.push_back({x.p, depth_ > 0 ? latest_[depth_ - 1] : -1});
    }
    if (story_) story_->meets(x, vertices_.size());
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
    if (story_) story_->goes_on(wi, f, pdf_w, specular, beta);
}

void Recorder::note_roulette(float q, Rgb beta) {
    if (!at_light_) beta_[depth_ - 1] = beta;
    if (story_) story_->survives(q, beta);
}

void Recorder::note_step_back() {
    depth_--;
    if (story_) story_->steps_back(eye_vertex(depth_));
}

void Recorder::note_back_to(int t) {
    while (depth_ + 2 > static_cast<size_t>(t)) note_step_back();
}

void Recorder::note_cut() {
    if (story_) story_->is_cut();
}

std::string Recorder::class_of(std::string path_class, size_t events) const {
    path_class.append(scattered_, scattered_.size() - events);
    return path_class += 'E';
}

void Recorder::note_emitted(Rgb Le, float mis_b) {
    bool sky = story_ && story_->has_left();
    keep({class_of("L", depth_), beta() * Le * mis_b, Contribution::own_pixel, eye_vertex(depth_),
          sky ? "sky met" : "light met", mis_b});
}

void Recorder::note_direct(Rgb Ld, Vec3 wi, float pdf_l, float pdf_b, float mis_l) {
    if (is_black(Ld)) return;
    if (story_) story_->samples_light(wi, pdf_l, pdf_b);
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
    if (story_) story_->adds(added);
}
