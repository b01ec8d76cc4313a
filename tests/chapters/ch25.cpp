// Chapter 25: photons as one more strategy of the bidirectional chapters.
#include <doctest/doctest.h>

#include "chapters/22_fast_bidirectional/estimator.h"
#include "chapters/25_vertex_merging/estimator.h"
#include "common/path/subpaths.h"
#include "tests/support/directions.h"
#include "tests/support/estimators.h"
#include "tests/support/light_paths.h"

namespace {

/// All that is seen of a whole path, from the light x[0] on to the eye: x[k] is the last surface.
struct WholePath {
    Path from_light;            // as the walk from the light left them
    std::vector<Hit> from_eye;  // [i]: the vertex i + 1 steps from the eye
    size_t light = 0;
};

/// The same points as a path from the eye meets them; nothing where it does not.
bool add_eye_vertices(const Scene& scene, const Pinhole& camera, WholePath& path) {
    Vec3 o = camera.view.o;
    for (size_t i = path.from_light.size(); i-- > 0;) {
        Vec3 target = path.from_light[i].x.p, d = normalize(target - o);
        std::optional<Hit> x = intersect(
            scene, path.from_eye.empty() ? Ray{o, d} : spawn_ray(path.from_eye.back(), d));
        if (!x || length(x->p - target) > 2e-5f * scene.radius) return false;
        path.from_eye.push_back(*x);
        if (i == 0) break;
        Vec3 wi = normalize(path.from_light[i - 1].x.p - x->p);
        if (pdf_onwards(scene, false, *x, -d, wi) == 0) return false;
        if (pdf_onwards(scene, true, *x, wi, -d) == 0) return false;
        o = x->p;
    }
    return true;
}

double cosine(Vec3d a, Vec3d b) { return dot(a, b) / std::sqrt(dot(a, a) * dot(b, b)); }

/// The density, in sr^-1, with which a path goes on at x, where its normals are the surface's; the
/// same from both sides. In double, and by formulas of its own.
double density_onwards(const Hit& x, Vec3d from, Vec3d to) {
    if (is_specular(*x.material)) return 1;
    Vec3d n(x.ng);
    double cos_o = cosine(from, n), cos_i = cosine(to, n);
    if (cos_o * cos_i <= 0) return 0;
    if (x.material->type == MaterialType::diffuse) return std::abs(cos_i) / pi_exact;
    Vec3d half = from / std::sqrt(dot(from, from)) + to / std::sqrt(dot(to, to));
    double cos_h = cosine(half, n), alpha = double{x.material->alpha};
    double D = alpha * alpha / pi_exact / std::pow(1 + cos_h * cos_h * (alpha * alpha - 1), 2);
    return D / (1 + RoughMetal{alpha, 0, 0}.lambda(cos_o)) / (4 * std::abs(cos_o));
}

/// The balance heuristic as it is written: densities of the whole path by each strategy, in double
/// and without a line of the lesson. Connections by s; with an area, N pi r^2, then merges by the
/// number of their vertex.
std::vector<double> densities_of(const Scene& scene, const Endpoints& endpoints,
                                 const WholePath& path, double area_of_merges = 0) {
    const auto& y = path.from_light;
    size_t n = y.size();  // vertices but the eye
    auto p = [&](size_t i) { return Vec3d(i < n ? y[i].x.p : endpoints.camera.view.o); };
    auto hit = [&](size_t i) { return path.from_eye[n - 1 - i]; };
    auto specular = [&](size_t i) { return i > 0 && i < n && is_specular(*y[i].x.material); };
    auto to = [&](size_t a, size_t b) { return p(b) - p(a); };
    auto area = [&](size_t from, size_t at) {  // of one sr at `from`, in m^-2 at `at`
        Vec3d d = to(from, at);
        return std::abs(cosine(d, Vec3d(hit(at).ng))) / dot(d, d);
    };
    // Of each vertex, when it comes from the light, and from the eye.
    std::vector<double> light(n), eye(n);
    for (size_t i = 0; i < n; i++) {
        if (i == 0) {
            double sides = scene.lights[path.light].two_sided ? 2 : 1;
            light[i] = static_cast<double>(pmf_light(endpoints.lights, path.light) *
                                           pdf_area(scene, path.light)) /
                       sides;
        } else {
            double pdf_w = i == 1 ? std::abs(cosine(to(0, 1), Vec3d(hit(0).ng))) / pi_exact
                                  : density_onwards(hit(i - 1), to(i - 1, i - 2), to(i - 1, i));
            light[i] = pdf_w * area(i - 1, i);
        }
        double cos_c = cosine(to(n, i), Vec3d(endpoints.camera.axis));
        double pdf_w = i == n - 1 ? 1 / (double{endpoints.camera.area} * cos_c * cos_c * cos_c)
                                  : density_onwards(hit(i + 1), to(i + 1, i + 2), to(i + 1, i));
        eye[i] = pdf_w * area(i + 1, i);
    }
    std::vector<double> of_strategy(n + 1);  // by s; the eye alone comes from no light
    for (size_t s = 0; s <= n; s++) {
        bool joined = s == 0 || (!specular(s - 1) && !specular(s));
        bool left_out = s == n && n < 3;  // direct light, or the light, connected to the camera
        double density = joined && !left_out ? 1 : 0;
        for (size_t i = 0; i < n; i++) density *= i < s ? light[i] : eye[i];
        of_strategy[s] = density;
    }
    for (size_t at = 0; at < n && area_of_merges > 0; at++) {
        bool merges = at > 1 && specular(at - 1) && !specular(at) && y[at - 1].x.light < 0 &&
                      y[at].x.material->type == MaterialType::diffuse;
        double density = merges ? area_of_merges : 0;
        for (size_t i = 0; i < n; i++) {
            if (i <= at) density *= light[i];
            if (i >= at) density *= eye[i];
        }
        of_strategy.push_back(density);
    }
    return of_strategy;
}

Method by_22(const Scene& scene) { return method_of<ch22::trace>(ch22::prepare(scene)); }
Method by_25(const Scene& scene, const PhotonSettings& settings = {.light_paths = 0}) {
    return ch25::merging_passes(scene, settings);
}

/// The weights of the lesson: of connections by s, then of merges by the number of their vertex;
/// -1 where there is none.
std::vector<double> lesson_weights(const Scene& scene, ch25::Merging& merging,
                                   const WholePath& path) {
    size_t n = path.from_light.size();
    Subpath light = {true, path.from_light}, eye = {false, Path(1)};
    Vec3 from = eye.path[0].x.p = merging.endpoints.camera.view.o;
    for (const Hit& x : path.from_eye) {
        Ray ray = {from, normalize(x.p - from)};
        eye.path.push_back(vertex_at(scene, merging.endpoints, x, ray, {1, 1, 1}));
        from = x.p;
    }
    ch25::add_sums(scene, merging, light);
    ch25::add_sums(scene, merging, eye);
    std::vector<double> weights;
    for (size_t s = 0; s <= n; s++)
        weights.push_back(
            static_cast<double>(ch25::mis_weight(scene, merging, light, s, eye, n + 1 - s)));

    // A merge's weight is what one photon of flux 1 at this place brings: the kernel is 2 there.
    ch25::LightPaths all;
    ch25::add_light_path(scene, light, merging.area, 1, all);
    float r = 1e-4f * scene.radius;
    for (size_t at = 0; at < n; at++) {
        weights.push_back(-1);
        for (Photon photon : all.photons) {
            if (photon.depth != static_cast<int>(at)) continue;
            size_t t = n + 1 - at;  // of the vertex from the eye at the same place
            photon.flux = {1, 1, 1}, photon.p = eye.path[t - 1].x.p;
            merging.paths = all, merging.map = PhotonMap(std::span(&photon, 1), r);
            Recorder recorder;
            Rgb L = ch25::merge(scene, merging, eye, t, recorder);
            double rho = static_cast<double>(eye.path[t - 1].x.material->reflectance.g);
            double whole = 2 * rho / pi_exact / (pi_exact * double{r} * double{r});
            weights.back() = static_cast<double>(L.g) / whole;
        }
    }
    return weights;
}

}  // namespace

TEST_SUITE("ch25 weights") {
    TEST_CASE("identity: weights of connections and merges are p_i / sum p over whole paths" *
              doctest::skip()) {
        struct {
            std::string name, how;
            float area;  // over the square of the scene's radius
        } cases[] = {{"cornell-spheres", "", 0.1f},
                     {"cornell-spheres", "", 10},
                     {"cornell-spheres", "", 1e-3f},
                     {"light-in-glass", "", 0.1f},
                     {"light-in-glass", "", 10},
                     {"sds", "", 0.1f},
                     {"caustic", "", 1},
                     {"cornell-spheres", "two-sided", 0.1f},
                     {"light-in-glass", "two-sided", 1}};
        for (const auto& c : cases) {
            CAPTURE(c.name);
            Scene scene = scene_from("scenes/" + c.name + ".pbrt", 32, 8);
            change(scene, c.how);
            ch25::Merging merging{endpoints_of(scene), many_lights::prepare(scene)};
            merging.area = c.area * scene.radius * scene.radius;
            Sampler sampler(SamplerType::independent, 1, 1);
            Recorder recorder;
            int connections = 0, merges = 0;
            RunningStats errors;
            for (uint32_t i = 0; i < 60000; i++) {
                sampler.start(i, 0);
                Path walk = light_subpath(scene, merging.endpoints, sampler, recorder);
                size_t n = 3 + i % 5;  // vertices of the path, but the eye
                if (walk.size() < n) continue;
                walk.resize(n);
                WholePath path{walk, {}, 0};
                if (!walk.back().connectible) continue;
                if (is_black(walk.back().x.material->reflectance)) continue;
                if (!add_eye_vertices(scene, merging.endpoints.camera, path)) continue;
                if (path.from_eye.back().light < 0) continue;
                path.light = static_cast<size_t>(path.from_eye.back().light);
                std::vector<double> p =
                    densities_of(scene, merging.endpoints, path, static_cast<double>(merging.area));
                std::vector<double> weights = lesson_weights(scene, merging, path);
                REQUIRE(p.size() == weights.size());
                double all = 0, sum = 0;
                for (double density : p) all += density;
                for (size_t k = 0; k < p.size(); k++) {
                    bool is_merge = k > n;
                    if (is_merge) CHECK((p[k] > 0) == (weights[k] >= 0));
                    if (p[k] == 0) continue;
                    CAPTURE(n);
                    CAPTURE(k);
                    double error = std::abs(weights[k] - p[k] / all);
                    CHECK(error < 5e-3);  // where two vertices nearly touch
                    errors.add(error);
                    sum += weights[k];
                    connections += !is_merge, merges += is_merge;
                }
                CHECK(std::abs(sum - 1) < 5e-3);
            }
            CHECK(errors.mean() < 2e-5);
            CHECK(connections > 200);
            CHECK(merges > 50);
        }
    }

    TEST_CASE("failure: light that comes along a surface, from glass that touches it") {
        Material glass, wall;
        glass.type = MaterialType::dielectric;
        Subpath walk{true, Path(3)};
        walk.path[1].x.material = &glass, walk.path[2].x.material = &wall;
        walk.path[1].x.light = -1;
        walk.path[2].x.p = {1, 0, 0}, walk.path[2].x.n = walk.path[2].x.ng = {0, 0, -1};
        for (float towards : {0.0f, 0.1f}) {
            walk.terms.assign(3, {.pdf = 1, .back = normalize(Vec3{-1, 0, -towards})});
            ch25::LightPaths paths;
            ch25::add_light_path(Scene{}, walk, 1, 1, paths);
            CHECK(paths.vertices.size() == 2);
            CHECK(paths.photons.size() == (towards > 0 ? 1 : 0));
        }
    }

    TEST_CASE("identity: the weights of a pass are made for the radius of its map") {
        Scene scene = scene_from("scenes/sds.pbrt", 8, 4);
        PhotonSettings settings{.light_paths = 1000, .radius = 0.3f};
        ch25::Merging merging{endpoints_of(scene), many_lights::prepare(scene)};
        for (uint32_t pass : {0u, 1u, 50u}) {
            ch25::trace_light_paths(
                scene, settings, pass, 1, [] { return false; }, merging);
            double r{merging.map.radius()};
            CHECK(r == nearly(double{radius_of(settings.radius, pass)}, 1e-5));
            CHECK(double{merging.area} == nearly(1000 * pi_exact * r * r, 1e-5));
            CHECK(merging.map.size() > 100);
        }
    }
}

TEST_SUITE("ch25 vertex merging") {
    TEST_CASE("variance: light in mirrors: a fourth of the error of chapter 22" * doctest::skip()) {
        Scene scene = scene_from("scenes/sds.pbrt", 32, 8);
        BlockMeans own{32, 8};
        for (uint32_t seed = 0; seed < 8; seed++) {
            Method method = by_25(scene, {.seed = seed, .light_paths = 0});
            own.add(film_of_classes(scene, method, 16, "LS+D.*E", seed).image());
        }
        BlockMeans other = blocks_of(scene, by_22(scene), 16, 8, 8, "LS+D.*E");
        CAPTURE(other.variance() / own.variance());
        CHECK(own.variance() < other.variance() / 4);
    }
}
