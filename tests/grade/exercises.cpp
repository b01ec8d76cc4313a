// The exercises, which a script writes.
#include <doctest/doctest.h>

#include "tests/support/process.h"

namespace {

bool says(const std::string& text, const std::string& words) {
    CAPTURE(text);
    return text.find(words) != std::string::npos;
}

/// Writes the exercise of a chapter, and returns what the script printed.
std::string exercise(const std::string& number, const TemporaryFolder& folder) {
    std::string command = "common/tools/exercise " + number + " " + folder.path() + " 2>&1";
    return Process([&] { return std::system(command.c_str()) == 0 ? 0 : 1; }).wait().out;
}

}  // namespace

TEST_SUITE("exercises") {
    TEST_CASE("identity: an exercise keeps signatures, docstrings and headlines, and no more") {
        TemporaryFolder folder;
        CHECK(says(exercise("09", folder), "sample_area_light, sample_one_light, sample_light, "));
        std::string text = read_file(folder / "09_light_sampling/estimator.h");
        CHECK(says(text, "///   by area:  pdf_w = pdf_A d^2 / cos_y"));
        CHECK(says(text, "inline LightSample sample_light(const Scene& scene, const Hit& x,"));
        CHECK(says(text, "    // Sample a light.\n"));
        CHECK(says(text, "    // Yours.\n"));
        CHECK(says(text, "    return x.material->reflectance / pi;"));  // as in chapter 08
        CHECK(says(text, "    not_written(\"sample_light\");\n}"));
        CHECK_FALSE(says(text, "y.pdf_w /= static_cast<float>(N);"));
        // trace of 09 differs in few lines from that of 08, and so do seven functions of 10.
        CHECK(says(text, "direct_light(scene, *x"));
        CHECK(says(exercise("10", folder),
                   ":\n    sample_cosine_hemisphere, "
                   "pdf_cosine_hemisphere, invert_cosine_hemisphere\n"));
        // A reader's file is never touched.
        std::string mine = folder / "09_light_sampling/estimator.h";
        write_file_atomically(mine, "mine");
        CHECK(says(exercise("09", folder), "stays as it is"));
        CHECK(read_file(mine) == "mine");
        CHECK(says(exercise("99", folder), "usage: make exercise CH=09"));
    }
}
