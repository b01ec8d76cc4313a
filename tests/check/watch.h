// Looks whether a chapter comes to an end: tells a loop without one from code that is only slow.
#pragma once
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <mutex>
#include <string>
#include <thread>

#include "common/base/ray_count.h"
#include "tests/methods/table.h"

/// While it lives, the program ends with code 4 and says where, if one path traces very many rays,
/// or if a path, or what is prepared before the paths, takes this long.
class Watch {
public:
    static constexpr uint64_t most_rays = 30000;  // of one path

    /// most      s, of processor time
    explicit Watch(double most) : most_(most) {}
    ~Watch() {
        ends_ = true;
        looks_.join();
    }
    Watch(const Watch&) = delete;
    Watch& operator=(const Watch&) = delete;

    /// What follows renders this scene.
    void renders(const std::string& scene) {
        std::lock_guard lock(mutex_);
        scene_ = scene;
    }

    /// The same method, watched.
    NamedMethod watched(NamedMethod method) {
        method.make = [this, make = method.make](const Scene& scene, RenderOptions& options) {
            Method made = make(scene, options);
            made.trace = [this, trace = made.trace](const Scene& s, const Ray& ray, Splats& splats,
                                                    Sampler& sampler, Recorder& recorder) {
                OnAPath path(*this);
                return trace(s, ray, splats, sampler, recorder);
            };
            return made;
        };
        return method;
    }

private:
    struct OnAPath {
        explicit OnAPath(Watch& w) : watch(w) {
            std::lock_guard lock(watch.mutex_);
            watch.rays_before_ = rays_traced;
            watch.rays_ = &rays_traced;
        }
        ~OnAPath() {
            std::lock_guard lock(watch.mutex_);
            watch.rays_ = nullptr;
            watch.steps_++;
        }
        Watch& watch;
    };

    void look() {
        constexpr std::chrono::milliseconds pause(30);
        double last_step = 0;
        for (uint64_t seen = 0; !ends_; std::this_thread::sleep_for(pause)) {
            double now = static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
            std::lock_guard lock(mutex_);
            if (steps_ != seen) seen = steps_, last_step = now;
            uint64_t rays = rays_ != nullptr ? *rays_ - rays_before_ : 0;
            if (rays > most_rays || now - last_step > most_) end(rays, now - last_step);
        }
    }
    [[noreturn]] void end(uint64_t rays, double seconds) const {
        std::string what = "what is prepared before the paths has no end";
        if (rays_ != nullptr)
            what = "a path has no end: it traced " + std::to_string(rays) + " rays";
        std::printf("No end: in `%s` %s in %.1f s.\n", scene_.c_str(), what.c_str(), seconds);
        std::fflush(stdout);
        std::_Exit(4);
    }

    const double most_;
    std::mutex mutex_;  // of what follows
    std::string scene_;
    uint64_t steps_ = 0;              // paths, and what was prepared
    const RayCount* rays_ = nullptr;  // of the thread that follows a path
    uint64_t rays_before_ = 0;        // this path
    std::atomic<bool> ends_ = false;
    std::thread looks_{[this] { look(); }};
};
