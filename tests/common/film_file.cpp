// Films on disk: the same bytes in any order, and nothing wrong is ever added.
#include <doctest/doctest.h>

#include <fstream>
#include <limits>
#include <numeric>

#include "common/base/files.h"
#include "common/path/sampler.h"
#include "common/picture/film.h"
#include "tests/support/folder.h"
#include "tests/support/gates.h"

namespace {

/// Numbers of all sizes, some below 0, some 0.
float any_float(Sampler& sampler) {
    float u = sampler.u1();
    if (u < 0.1f) return 0;
    float x = std::pow(10.0f, 60 * sampler.u1() - 30);
    return u < 0.2f ? -x : x;
}

/// Samples first to last - 1 of a made-up render of 5 x 3 pixels, some of them not finite. `kind`:
/// 0: pixels alone; 1: with audits; 2: with a second half of each; 3: with batches; 4: with batches
/// and audits.
LabeledFilm film_of(uint32_t first, uint32_t last, uint32_t seed = 1, int kind = 1,
                    bool takes_splats = true) {
    LabeledFilm f{{}, Film(5, 3, takes_splats)};
    f.label.options = {{"chapter", "07"}, {"checksum", "abc"}, {"paths", ""}, {"m", "16"}};
    f.label.samples = {{seed, first, last, {9, last - first < 9 ? 3u : 1u}}};
    for (size_t i = 7; (kind == 1 || kind == 4) && i < 15; i += 3) f.film.mark_edge(i);
    if (kind == 1 || kind == 4) f.film.start_audit();
    if (kind == 2) f.film.start_halves();
    if (kind >= 3) f.film.start_batches();
    Sampler sampler(SamplerType::independent, seed, 1);
    for (uint32_t s = first; s < last; s++) {
        PixelSum of_pass;
        for (uint32_t i = 0; i < 15; i++) {
            sampler.start(i, s);
            auto any = [&] { return any_float(sampler); };
            Rgb L = {any(), any(), i + s == 5 ? infinity : any()};
            if (!is_finite(L)) f.label.counts.add_not_finite({seed, 0, 5, static_cast<int>(s)});
            f.film.add(i, L, kind == 2 ? s % 2 : 0);
            if (f.film.has_audits() && f.film.is_audited(i)) f.film.add(i, {any(), 1, 1}, 1);
            if (takes_splats) f.film.splat(7 * (i + s) % 15, {any(), 1, 1});
            if (takes_splats) f.film.add_total(i, {any(), 1, 1});
            of_pass.add(L);
            f.label.counts.rays += 3;
        }
        if (kind >= 3) f.film.add_to_batch(s, of_pass);
    }
    return f;
}

std::string bytes_of(const LabeledFilm& f) {
    TemporaryFolder folder;
    write_film(folder / "a.film", f.label, f.film);
    return read_file(folder / "a.film");
}

LabeledFilm read_back(const std::string& bytes) {
    TemporaryFolder folder;
    write_file_atomically(folder / "a.film", bytes);
    return read_film(folder / "a.film");
}

std::string refusal(const std::string& bytes) {
    TemporaryFolder folder;
    std::ofstream(folder / "a.film", std::ios::binary) << bytes;
    std::string error = error_of([&] { read_film(folder / "a.film"); });
    CHECK((error.empty() || error.starts_with(folder / "a.film" + ": error: ")));
    return error.substr(error.empty() ? 0 : (folder / "a.film").size() + 9);
}

}  // namespace

TEST_SUITE("film files") {
    TEST_CASE("identity: a pixel's sums have the same bits in any order and any grouping") {
        for (uint32_t seed = 0; seed < 100; seed++) {
            Sampler sampler(SamplerType::independent, seed, 1);
            std::vector<Rgb> samples;
            PixelSum whole, groups;
            for (uint32_t i = 0; i < 300; i++) {
                sampler.start(0, i);
                samples.push_back({any_float(sampler), any_float(sampler), any_float(sampler)});
                whole.add(samples.back());
            }
            for (size_t end = 300, size = 1; end > 0; end -= std::min(end, size++)) {
                PixelSum group;
                for (size_t i = end - std::min(end, size); i < end; i++) group.add(samples[i]);
                groups.add(group);
            }
            CHECK(std::memcmp(&groups, &whole, sizeof whole) == 0);
        }
    }

    TEST_CASE("identity: films of parts, added in any order, have the bytes of the whole") {
        // And each film is read back as it was written.
        for (int kind : {0, 1, 2, 3, 4})
            for (bool takes_splats : {false, true}) {
                if (kind == 2 && takes_splats) continue;
                CAPTURE(kind);
                std::string whole = bytes_of(film_of(0, 9, 0, kind, takes_splats));
                CHECK(bytes_of(read_back(whole)) == whole);
                uint32_t ends[] = {0, 1, 2, 5, 9};
                std::vector<size_t> parts = {0, 1, 2, 3};
                do {
                    auto part = [&](size_t i) {
                        return film_of(ends[parts[i]], ends[parts[i] + 1], 0, kind, takes_splats);
                    };
                    LabeledFilm sum = part(0);
                    for (size_t i : {1u, 2u, 3u}) add_film(sum, "part", part(i));
                    REQUIRE(bytes_of(sum) == whole);
                } while (std::next_permutation(parts.begin(), parts.end()));
            }
        // Other seeds are other samples.
        LabeledFilm a = film_of(0, 5, 1), b = film_of(2, 6, 4294967295u);
        add_film(a, "b", film_of(2, 6, 4294967295u));
        add_film(b, "a", film_of(0, 5, 1));
        CHECK(bytes_of(a) == bytes_of(b));
        CHECK(a.label.samples ==
              std::vector<SampleRange>{{1, 0, 5, {9, 3}}, {4294967295u, 2, 6, {9, 3}}});
        a.label.options[2].second = "L(D | S)*E";
        CHECK(read_back(bytes_of(a)).label.options == a.label.options);
        CHECK(read_back(bytes_of(a)).label.samples == a.label.samples);
    }

    TEST_CASE("teeth: the same samples twice, and other options, are refused and change nothing") {
        LabeledFilm sum = film_of(4, 9), other = film_of(9, 12),
                    no_splats = film_of(9, 12, 1, 1, false);
        other.label.options[3].second = "17";
        std::string before = bytes_of(sum);
        for (const auto& [part, why] :
             {std::pair(film_of(4, 9), "sample 4 of seed 1 would count twice"),
              {film_of(6, 7), "sample 6 of seed 1 would count twice"},
              {other, "its m is \"17\", here it is \"16\""},
              {no_splats, "a film by another version of the program"}}) {
            std::string error = error_of([&, &p = part] { add_film(sum, "b.film", p); });
            CHECK(error == "b.film: error: " + std::string(why));
            CHECK(bytes_of(sum) == before);
        }
    }

    TEST_CASE("teeth: a film with any bit flipped, or cut anywhere, is refused") {
        std::string bytes = bytes_of(film_of(0, 2));
        for (size_t bit = 0; bit < 8 * bytes.size(); bit += 37) {
            std::string flipped = bytes;
            flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ 1 << bit % 8);
            REQUIRE(refusal(flipped) != "");
        }
        for (size_t length = 0; length < bytes.size(); length += 19)
            REQUIRE(refusal(bytes.substr(0, length)) != "");
        const std::string other = "not a film, or one by another version of the program";
        CHECK(refusal("P6\n1 1\n255\n000") == other);
        CHECK(refusal(bytes.replace(bytes.find("version 9"), 9, "version 8")) == other);
        CHECK(refusal(bytes_of(film_of(0, 2)) + "x") == "the film is damaged, or cut short");
    }

    TEST_CASE("truth: what is missing is named, sample by sample and part by part") {
        auto missing = [](const std::vector<SampleRange>& samples) {
            return FilmLabel{{}, samples, {}}.missing();
        };
        using Lines = std::vector<std::string>;
        CHECK(missing({{0, 0, 9, {6, 5}}}) == Lines{});
        CHECK(missing({{0, 1, 2, {6, 5}}, {0, 4, 6, {6, 5}}}) ==
              Lines{"missing: sample 0 of seed 0, part 1 of 5",
                    "missing: samples 2 to 3 of seed 0, part 3 to 4 of 5"});
        CHECK(missing({{0, 0, 1, {6}}, {0, 8, 9, {6}}}) ==
              Lines{"missing: samples 1 to 7 of seed 0"});
        CHECK(missing({{3, 0, 9}}) == Lines{});
        // Of several renders of one seed the largest counts; and each seed by itself.
        LabeledFilm sum = film_of(0, 3, 0), larger = film_of(3, 7, 0);
        larger.label.samples[0].goal = {11, 2};
        add_film(sum, "b", larger);
        add_film(sum, "c", film_of(0, 4));
        CHECK(sum.label.missing() == Lines{"missing: samples 7 to 10 of seed 0, part 2 of 2",
                                           "missing: samples 4 to 8 of seed 1, part 2 to 3 of 3"});
    }
}
