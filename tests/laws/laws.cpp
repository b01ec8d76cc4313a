#include "tests/laws/laws.h"

#include "common/recording/class_filter.h"
#include "tests/known/scenes.h"
#include "tests/support/light_paths.h"

std::vector<NamedMethod> methods_for(const Scene& scene) {
    std::vector<NamedMethod> methods;
    for (const NamedMethod& m : all_methods()) {
        bool as_another = m.name.ends_with("-sobol") || m.name == "12-m32" || m.name == "15-m16";
        if (!as_another && can_render(m, scene)) methods.push_back(m);
    }
    return methods;
}

Scene seen_along(Scene scene, const Ray& ray) {
    Camera& camera = scene.camera;
    camera.o = ray.o, camera.forward = normalize(ray.d);
    Vec3 aside = std::abs(camera.forward.y) < 0.9f ? Vec3{0, 1, 0} : Vec3{0, 0, 1};
    camera.right = normalize(cross(camera.forward, aside));
    camera.up = cross(camera.right, camera.forward);
    camera.fov = 0.001f;
    scene.width = scene.height = 1;
    return scene;
}

Scene random_scene(uint32_t number) { return scene_of(random_world(13, number)); }

Scene lit_floor(const std::string& lights) { return seen_along(floor_under(lights), onto_origin); }

namespace {

/// The classes that paths from the camera find although lights have no size, and those that paths
/// from the lights show to a pinhole.
const std::string sampled = "L(D(S|D)*)?E";

/// Adds one sample: the mean over the paths of a pass.
void add_pass(const Census& paths, Census& passes) {
    passes.samples++;
    for (const auto& [name, sum] : paths.parts) {
        PathSum& part = passes.parts[name];
        uint64_t met = part.not_zero + sum.not_zero;
        part.add(sum.sum / paths.samples);
        part.not_zero = met;
    }
}

Census census_of(const Scene& scene, const NamedMethod& row, int paths, uint32_t seed,
                 bool classes) {
    RenderOptions options;
    options.seed = seed;
    Method method = row.make(scene, options);
    auto census = [&](int first, int count) {
        return census_of(scene, method, count, seed, {sampled, shown_by_light}, classes, first);
    };
    if (!method.prepare) return census(0, paths);
    // Paths of a pass depend on each other.
    Census passes;
    int count = std::clamp(paths / 64, 64, 512), each = paths / count;
    for (int pass = 0; pass < count; pass++) {
        method.prepare(static_cast<uint32_t>(pass), 1, [] { return false; });
        add_pass(census(pass * each, each), passes);
    }
    return passes;
}

}  // namespace

Measured brightness(const Scene& scene, const NamedMethod& method, int paths, uint32_t seed) {
    return census_of(scene, method, paths, seed, false).measured("all");
}

/// Whether the method finds all light of this class of path, or of this sum, where lights may have
/// no size: such lights are never met, and no light path reaches a pinhole through a mirror.
static bool finds_all(const NamedMethod& method, bool no_size, const std::string& name) {
    static ClassFilter by_eye(sampled), by_light(shown_by_light);
    bool shown = name[0] == 'L' ? by_light.matches(name) : name == "all " + shown_by_light;
    bool aimed = name[0] == 'L' ? by_eye.matches(name) : name == "all " + sampled;
    if (method.search == LightSearch::from_lights) return shown;
    if (method.biased() || !no_size) return true;
    return aimed || (shown && method.search == LightSearch::both_ends);
}

/// Compares what a method found with what is known of the same light. Who has too few paths of a
/// class may have met too little of it: such numbers are left out. Returns how many were compared;
/// adds what the method found to `known`, unless it blurs. No path is longer than the scene says.
static int compare(const NamedMethod& method, const Scene& scene, const Census& census,
                   std::map<std::string, Measured>& known) {
    bool no_size = std::ranges::any_of(scene.lights, [](const Light& light) {
        return light.type == LightType::point || light.type == LightType::distant;
    });
    CAPTURE(method.name);
    CHECK_FALSE(census.parts.contains("length " + std::to_string(scene.max_depth + 1)));
    int compared = 0;
    for (const auto& [its_name, part] : census.parts) {
        const std::string& name = its_name;
        Measured m = part.measured(census.samples);
        if (part.not_zero < 100 || m.se > 0.3 * m.mean) continue;
        if (!finds_all(method, no_size, name)) continue;
        if (known.contains(name)) {
            CAPTURE(name);
            CAPTURE(m.mean);
            CAPTURE(known[name].mean);
            double se = std::hypot(m.se, known[name].se);
            double allowed = (method.blurs() ? 0.01 : 1e-6) * m.mean;
            CHECK(std::abs(m.mean - known[name].mean) <= 5 * se + allowed);
            compared++;
        }
        if (!method.blurs()) known[name] = m;
    }
    return compared;
}

void check_light(const Scene& scene, const KnownLight& light) {
    const int few = 2048, most = light.most;
    bool one_ray = scene.width == 1;  // which no path from a light happens to meet
    int tested = 0;
    for (const NamedMethod& method : methods_for(scene)) {
        bool blurs = method.blurs(), from_lights = method.search == LightSearch::from_lights;
        if (blurs && !(light.even && method.name.ends_with("-few"))) continue;
        if (from_lights && (one_ray || light.mean == 0)) continue;
        if (std::ranges::count(light.except, method.name)) continue;
        CAPTURE(method.name);
        double bound = light.relative_se;
        Measured m;
        int paths = few;
        for (uint64_t met = 0; met < 50 && paths < most; paths *= 8) {
            Census pilot = census_of(scene, method, paths, 2, false);
            met = pilot.parts["all"].not_zero;
            m = pilot.measured("all");
            if (light.mean == 0) break;
        }
        if (light.mean > 0) {
            double wanted = paths / 8 * std::pow(m.se / (0.6 * bound * light.mean), 2);
            if (wanted > most / 8 && (method.random_hits() || blurs || from_lights))
                bound *= 3, wanted /= 9;
            // Hardly ever met.
            if ((method.random_hits() || from_lights) && (m.mean == 0 || wanted > most)) continue;
            paths = static_cast<int>(std::clamp<double>(wanted, few, most));
            Census census = census_of(scene, method, paths, 1, !light.parts.empty());
            m = census.measured("all");
            std::map<std::string, Measured> parts;
            for (const auto& [name, q] : light.parts) parts[name] = {q.mean, q.se + 1e-5 * q.mean};
            compare(method, scene, census, parts);
        }
        tested++;
        CAPTURE(m.mean);
        CAPTURE(light.mean);
        double se = std::hypot(m.se, light.se), known = (blurs ? 0.01 : 2e-6) * light.mean;
        CAPTURE(se);
        CHECK(std::abs(m.mean - light.mean) <= 5 * se + known);
        CHECK(se <= bound * light.mean);
    }
    CHECK(tested > 0);
}

int check_classes_agree(const Scene& scene, int paths, uint32_t seed, bool blurred) {
    std::map<std::string, Measured> known;
    int compared = 0;
    for (const NamedMethod& method : methods_for(scene)) {
        if ((method.biased() && method.is_variant()) || (method.blurs() && !blurred)) continue;
        compared += compare(method, scene, census_of(scene, method, paths, seed++, true), known);
    }
    return compared;
}

void check_same_light(const Scene& a, const std::vector<Scene>& others, int paths) {
    for (const NamedMethod& method : methods_for(a)) {
        if (method.biased()) continue;
        std::map<std::string, Measured> known;
        compare(method, a, census_of(a, method, paths, 1, true), known);
        for (const Scene& b : others)
            CHECK(compare(method, b, census_of(b, method, paths, 2, true), known) >= 3);
    }
}
