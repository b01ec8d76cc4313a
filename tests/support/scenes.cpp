#include "tests/support/scenes.h"

#include "common/recording/class_filter.h"

Sampler random_numbers(uint32_t seed) {
    Sampler sampler(SamplerType::independent, seed, 1);
    sampler.start(0, 0);
    return sampler;
}

Vec3 uniform_direction(Vec2 u) {
    float z = 1 - 2 * u.x, r = std::sqrt(std::max(0.0f, 1 - z * z)), phi = 2 * pi * u.y;
    return {r * std::cos(phi), r * std::sin(phi), z};
}

Scene scene_of(const std::string& text) {
    Scene scene = parse_scene("test.pbrt", text, nullptr);
    prepare(scene, 1);
    return scene;
}

Scene world_of(const std::string& world, int size) {
    std::string pixels = std::to_string(size);
    Scene scene = scene_of(
        "LookAt 0 0 -4  0 0 0  0 1 0\n Camera \"perspective\" \"float fov\" 40\n"
        "Film \"rgb\" \"integer xresolution\" " +
        pixels + " \"integer yresolution\" " + pixels + "\nWorldBegin\n" + world);
    scene.max_depth = 100;
    return scene;
}

Scene leaning_wall() {
    return world_of(
        "LightSource \"infinite\" \"rgb L\" [0.2 0.3 0.4]\n"
        "AttributeBegin AreaLightSource \"diffuse\" Translate 1 2 -2 Shape \"sphere\" \"float "
        "radius\" 0.3 AttributeEnd\nMaterial \"diffuse\" Shape \"trianglemesh\" \"integer "
        "indices\" [0 1 2 0 2 3] \"point3 P\" [-1 -1 0  -1 1 0  1 1 0  1 -1 0] \"normal N\" [0.4 "
        "0.3 -1  0.1 0.2 -1  -0.3 0 -1  0 -0.4 -1]\n",
        16);
}

Scene scene_from(const std::string& path, int size, int max_depth) {
    Scene scene = scene_of(read_file(path));
    scene.width = scene.height = size;
    scene.max_depth = max_depth;
    return scene;
}

std::string square(float y, bool up) {
    std::string h = std::to_string(y);
    return "Shape \"trianglemesh\" \"integer indices\" " +
           std::string(up ? "[0 1 2 0 2 3]" : "[0 2 1 0 3 2]") + " \"point3 P\" [-1 " + h +
           " -1  -1 " + h + " 1  1 " + h + " 1  1 " + h + " -1]\n";
}

Rendering film_of(const Scene& scene, const Method& method, int spp, uint32_t seed,
                  SamplerType sampler, const std::string& paths) {
    Scene of_spp = scene;
    of_spp.spp = spp;
    RenderOptions options;
    options.seed = seed;
    options.sampler = sampler, options.paths = paths;
    options.threads = static_cast<int>(std::thread::hardware_concurrency());
    options.quiet = true;
    Rendering r = render_film(of_spp, options, method);
    REQUIRE(r.stats.not_finite == 0);
    return r;
}

double z_between(Measured a, Measured b) {
    double se = std::hypot(a.se, b.se), difference = std::abs(a.mean - b.mean);
    if (difference <= 1e-6 * std::abs(a.mean)) return 0;  // rounding; also where neither has noise
    return difference / se;
}

Measured block_of(const Film& film, int x0, int y0, int side) {
    double mean = 0, squares = 0;
    for (int y = y0; y < y0 + side; y++)
        for (int x = x0; x < x0 + side; x++) {
            const PixelSum& p = film.pixels()[static_cast<size_t>(y * film.width + x)];
            double n = static_cast<double>(p.n);
            mean += p.mean();
            squares += p.m2() / (n - 1) / n;
        }
    double pixels = static_cast<double>(side) * side;
    return {mean / pixels, std::sqrt(squares) / pixels};
}

Agreement hold_against(const Film& a, const Film& b, int block_side) {
    return hold_against(
        a.width, block_side, [&](int x, int y, int side) { return block_of(a, x, y, side); },
        [&](int x, int y, int side) { return block_of(b, x, y, side); });
}

void check_agreement(const Agreement& a, double relative_se) {
    INFO("image " << a.z_image << " standard errors, " << a.relative << " +- " << a.relative_se
                  << "; block " << a.worst_x << "," << a.worst_y << ": " << a.worst_z);
    CHECK(a.agrees());
    CHECK(a.relative_se <= relative_se);
}

/// The paths [first, last).
static Census part_of_census(const Scene& scene, const Method& method, int first, int last,
                             uint32_t seed, const std::vector<std::string>& filters, bool classes) {
    Census census{last - first};
    CameraView view = camera_view(scene.camera, scene.width, scene.height);
    Sampler sampler(SamplerType::independent, seed, 1);
    Recorder recorder(classes);
    std::vector<ClassFilter> chosen(filters.begin(), filters.end());
    Splats splats;
    Vec2 size = {static_cast<float>(scene.width), static_cast<float>(scene.height)};
    for (int i = first; i < last; i++) {
        sampler.start(0, static_cast<uint32_t>(i));
        recorder.start();
        splats.clear();
        Vec2 u = sampler.u2();
        Ray ray = camera_ray(view, {u.x * size.x, u.y * size.y});
        Rgb L = method.trace(scene, ray, splats, sampler, recorder);
        for (const Splat& splat : splats) L += splat.L;
        std::map<std::string, double> parts = {{"all", double{average(L)}}};
        for (const Contribution& part : recorder.contributions()) {
            double y = double{average(part.L)};
            parts[part.path_class] += y;
            parts["length " + std::to_string(part.path_class.size() - 2)] += y;
            for (size_t k = 0; k < filters.size(); k++)
                if (chosen[k].matches(part.path_class)) parts["all " + filters[k]] += y;
        }
        for (auto [name, y] : parts) census.parts[name].add(y);
    }
    return census;
}

Census census_of(const Scene& scene, const Method& method, int paths, uint32_t seed,
                 const std::vector<std::string>& filters, bool classes, int first) {
    return in_blocks<Census>(paths, [&](int begin, int end) {
        return part_of_census(scene, method, first + begin, first + end, seed, filters, classes);
    });
}
