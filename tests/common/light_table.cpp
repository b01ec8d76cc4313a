// Choosing one of many lights: that each gets its share of the random numbers, however small.
#include "common/light/light_table.h"

#include <doctest/doctest.h>

#include "common/path/many_lights.h"
#include "common/path/sampler.h"

namespace {

/// The first u, in steps of 2^-48, of which pick_light makes this light or a later one; for a table
/// in which the lights take u in turn.
double first_u_of(const LightTable& table, size_t light) {
    uint64_t low = 0, high = uint64_t{1} << 48;
    while (low < high) {
        uint64_t middle = (low + high) / 2;
        bool is_before = pick_light(table, static_cast<double>(middle) * 0x1p-48) < light;
        (is_before ? low : high) = is_before ? middle + 1 : middle;
    }
    return static_cast<double>(low) * 0x1p-48;
}

}  // namespace

TEST_SUITE("light table") {
    TEST_CASE("identity: each of a million lights gets its share of u, to 1e-6 of it") {
        constexpr size_t N = 1000003;
        LightTable table = build_light_table(std::vector<double>(N, 1.0 / N));
        for (size_t light : {size_t{0}, size_t{1}, N / 3, N / 2, N - 2, N - 1}) {
            double end = light + 1 < N ? first_u_of(table, light + 1) : 1;
            CHECK(std::abs((end - first_u_of(table, light)) * N - 1) < 1e-6);
        }
    }

    TEST_CASE("identity: of a million lights each candidate comes from its slice of the table") {
        constexpr int N = 1000003;
        std::vector<double> pmf;
        double sum = 0;
        for (uint32_t i = 0; i < N; i++) sum += pmf.emplace_back(1 + hash32(i) % 1000);
        for (double& p : pmf) p /= sum;
        many_lights::Lights lights{build_light_table(pmf), std::vector<LightBounds>(N),
                                   std::vector<float>(N, 1.0f), 64};
        const Material paint{};
        Hit x{};
        x.material = &paint;
        Sampler random(SamplerType::independent, 1, 1);
        random.start(0, 0);
        many_lights::Candidates c;
        for (int k = 0; k < 1000; k++) {
            double u = to_unit_double(random.u2());
            many_lights::choose_candidates(Scene(), lights, x, {0, 0, 1}, u, c);
            for (int i = 0; i < 64; i++)
                REQUIRE(c.light[i] == pick_light(lights.table, (i + u) / 64));
        }
    }
}
