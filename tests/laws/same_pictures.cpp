// Laws: what must not change a picture, and what a picture says of its own error.
#include "chapters/05_ray_casting/estimator.h"
#include "common/render/render.h"
#include "tests/laws/laws.h"
#include "tests/support/folder.h"
#include "tests/support/light_paths.h"

namespace {

/// What a path returns and adds to the splats: a number for each pixel, the path's own one last.
struct Sample {
    Splats splats;
    bool has_bits_of(const Sample& b) const {
        size_t n = splats.size();
        for (size_t i = 0; i < n && n == b.splats.size(); i++) {
            if (splats[i].pixel != b.splats[i].pixel) return false;
            if (!(splats[i].L == b.splats[i].L)) return false;
        }
        return n == b.splats.size();
    }
};
Sample sample_of(const Scene& scene, const Method& trace, uint32_t i, Recorder& recorder) {
    Sampler sampler(SamplerType::independent, 1, 1);
    sampler.start(0, i);
    Vec2 u = sampler.u2();
    float width = static_cast<float>(scene.width), height = static_cast<float>(scene.height);
    Ray ray = camera_ray(camera_view(scene.camera, scene.width, scene.height),
                         {width * u.x, height * u.y});
    recorder.start();
    Sample sample;
    Rgb L = trace.trace(scene, ray, sample.splats, sampler, recorder);
    sample.splats.push_back({Contribution::own_pixel, L});
    return sample;
}

/// The largest relative difference, in any pixel, of what was recorded and what was returned.
double difference(const Recorder& recorder, const Sample& sample) {
    std::map<size_t, double> recorded, returned;
    for (const Contribution& part : recorder.contributions())
        recorded[part.pixel] += static_cast<double>(average(part.L));
    for (const Splat& splat : sample.splats)
        returned[splat.pixel] += static_cast<double>(average(splat.L));
    double worst = recorded.size() > returned.size() ? 1 : 0;
    for (const auto& [pixel, L] : returned)
        worst = std::max(worst, std::abs(recorded[pixel] - L) / (L + 1e-20));
    return worst;
}

}  // namespace

TEST_SUITE("law: same pictures") {
    TEST_CASE("identity: recording never changes an estimate, and its parts add up to it") {
        std::map<std::string, int> lit;  // paths that brought light, by method
        for (uint32_t seed : {0u, 3u, 12u, 16u, 18u, 23u, 30u, 39u}) {
            CAPTURE(seed);
            Scene scene = random_scene(seed);
            scene.max_depth = seed % 2 == 0 ? 20 : 4;
            auto check = [&](const std::string& name, Method trace) {
                CAPTURE(name);
                if (trace.prepare) trace.prepare(9, 1, [] { return false; });
                Recorder none, all(true);
                int others = 0;
                double worst = 0;
                for (uint32_t i = 0; i < 400; i++) {
                    Sample unheard = sample_of(scene, trace, i, none);
                    Sample heard = sample_of(scene, trace, i, all);
                    others += !heard.has_bits_of(unheard);
                    lit[name] += !all.contributions().empty();
                    worst = std::max(worst, difference(all, heard));
                }
                CHECK(others == 0);
                CHECK(worst < 1e-5);
                CHECK(none.contributions().empty());
            };
            check("05", method_of<ch05::trace>());
            for (const NamedMethod& row : methods_for(scene))
                if (!row.biased() || row.name.ends_with("-few"))
                    check(row.name, method(row.name, scene));
        }
        for (const auto& [name, paths] : lit) {
            CAPTURE(name);
            CHECK(paths > 20);
        }
    }

    TEST_CASE("identity: where nothing is new, a picture is the chapter's before, bit for bit") {
        for (const auto& [before, now, scenes] :
             std::vector<std::tuple<std::string, std::string, std::string>>{
                 {"11", "13", "cornell-spheres two-lights thousand-lights"},
                 {"15", "16", "cornell cornell-spheres thousand-lights veach-mis leaning"},
                 {"16", "17", "cornell-spheres thousand-lights bokeh moving-ball leaning"},
                 {"17", "18", "cornell-spheres moving-ball bokeh leaning"},
                 {"22-direct", "25", "cornell two-lights lamp horizon-sky veach-mis"}}) {
            std::istringstream words(scenes);
            for (std::string name; words >> name;) {
                CAPTURE(now);
                CAPTURE(name);
                Scene scene = name == "leaning" ? leaning_wall()
                                                : scene_from("scenes/" + name + ".pbrt", 16, 8);
                scene.spp = 4;
                RenderOptions options;
                options.quiet = true, options.threads = 2;
                for (SamplerType type :
                     {SamplerType::independent, SamplerType::stratified, SamplerType::sobol}) {
                    options.sampler = type;
                    Rendering a = render(methods_named({before})[0], scene, options);
                    Rendering b = render(methods_named({now})[0], scene, options);
                    CHECK(a.film.mean() > 0);
                    CHECK(a.film.image().pixels == b.film.image().pixels);
                    CHECK((a.stats.rays == b.stats.rays || now == "25"));
                }
            }
        }
    }

    TEST_CASE("identity: the same bytes for any threads, parts and stops") {
        TemporaryFolder folder;
        Scene scene = random_scene(30);
        for (NamedMethod row : methods_for(scene)) {
            if (row.biased() && !row.name.ends_with("-few")) continue;
            CAPTURE(row.name);
            int spp = row.number() == 19 ? 40 : 7;  // more than a pilot
            auto rendered = [&](const std::string& film, int samples, int part, int threads) {
                RenderOptions options;
                options.quiet = true, options.threads = threads;
                options.film = folder / (row.name + film);
                options.part = std::max(1, part), options.parts = part > 0 ? 3 : 1;
                Scene of_spp = scene;
                of_spp.spp = samples;
                Rendering r = render(row, of_spp, options);
                save_film(of_spp, options, r);
                return read_film(options.film);
            };
            LabeledFilm whole = rendered("whole.film", spp, 0, 1);
            CHECK(whole.film.standard_error() > 0);
            rendered("threads.film", spp, 0, 3);
            auto bytes = [&](const std::string& film) {
                return read_file(folder / (row.name + film));
            };
            CHECK(bytes("threads.film") == bytes("whole.film"));

            LabeledFilm sum = rendered("3.film", spp, 3, 2);
            for (int part : {1, 2})
                add_film(sum, "", rendered("part.film" + std::to_string(part), spp, part, 2));
            CHECK(sum.film.image().pixels == whole.film.image().pixels);
            CHECK(sum.film.standard_error() == whole.film.standard_error());

            // A render with fewer samples that goes on: of chapter 19, in its pilot and after it.
            for (int fewer : {5, spp / 2}) {
                rendered("again.film" + std::to_string(fewer), fewer, 0, 2);
                rendered("again.film" + std::to_string(fewer), spp, 0, 2);
                CHECK(bytes("again.film" + std::to_string(fewer)) == bytes("whole.film"));
            }
        }
    }
}

TEST_SUITE("law: same pictures slow") {
    TEST_CASE("consistency: the reported error is the spread over seeds, with each sampler") {
        Scene scene = random_scene(30);
        scene.width = 10, scene.height = 8;
        for (const NamedMethod& row : methods_for(scene)) {
            if (row.biased() ? !row.name.ends_with("-few") : row.is_variant()) continue;
            // So many passes know their error; so many samples are more than a pilot.
            scene.spp = row.biased() || row.number() == 19 ? 32 : 8;
            for (SamplerType type :
                 {SamplerType::independent, SamplerType::stratified, SamplerType::sobol}) {
                CAPTURE(row.name);
                CAPTURE(type);
                RunningStats means, squares;
                RenderOptions options;
                options.quiet = true, options.threads = 1, options.sampler = type;
                for (uint32_t& seed = options.seed; seed < 200; seed++) {
                    Film film = render(row, scene, options).film;
                    means.add(film.mean());
                    squares.add(std::pow(film.standard_error(), 2));
                }
                double ratio = std::sqrt(squares.mean() / means.variance());
                CHECK(ratio > 1 / 1.25);  // the spread of 200 has a standard error of 5 %
                CHECK(ratio < 1.25);
            }
        }
    }
}
