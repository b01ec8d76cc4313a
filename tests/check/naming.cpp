#include "tests/check/naming.h"

#include <functional>
#include <numbers>

namespace {

constexpr double pi_exact = std::numbers::pi;

/// What rules ask.
struct Case {
    int chapter;
    const Findings& f;
    const Findings* other;  // the chapter's second way

    bool off(const char* probe, const char* name = "LDE") const { return f.off(probe, name); }
    bool right(const char* probe, const char* name = "LDE") const { return f.right(probe, name); }
    bool is(const char* probe, const char* name, double r) const { return f.is(probe, name, r); }
    double ratio(const char* probe, const char* name = "LDE") const {
        return f.ratio(probe, name).mean;
    }
    bool leaks(const char* probe) const { return !f.leak(probe).empty(); }
    /// Whether all of these are right in LDE.
    bool all_right(std::initializer_list<const char*> probes) const {
        for (const char* probe : probes)
            if (!right(probe)) return false;
        return true;
    }
    bool other_off(const char* probe) const { return other && other->off(probe); }
    bool other_right(const char* probe) const { return other && other->right(probe); }
    bool by_photons() const { return chapter == 23 || chapter == 24; }
    bool noisy(const char* probe, double times) const {
        Quantity r = f.ratio(probe, "noise");
        return r.mean - 3 * r.se > times;
    }
};

/// The first rule that applies has the say: those that explain more stand first.
struct Rule {
    const char *probe, *path_class;  // where it shows best
    const char* text;
    std::function<bool(const Case&)> applies;
};

/// What is wrong with the path as a whole: it ends, goes on or counts where it should not.
const std::vector<Rule> rules_of_paths = {
    {"half", "LDE",
     "light comes through a board: nothing casts a shadow. Is the shadow ray traced?",
     [](const Case& c) { return c.right("floor") && c.ratio("half") > 1.6; }},
    {"box", "leak",
     "light leaks into a closed box: photons of other surfaces count (or rays start at the point "
     "itself, not just off the surface)",
     [](const Case& c) { return c.by_photons() && c.leaks("box") && !c.f.leaks("box", "LDE"); }},
    {"box", "leak",
     "light leaks into a closed box: rays start at the point itself, not just off the surface",
     [](const Case& c) { return c.leaks("box"); }},
    {"sphere", "longer",
     "paths are one bounce longer than max_depth: where does the loop compare depth with it?",
     [](const Case& c) { return c.f.leaks("sphere", "longer"); }},
    {"sphere", "all",
     "the picture has less than its paths have found: a path that roulette ends loses what it "
     "found before",
     [](const Case& c) {
         double parts = Findings::find(c.f.measured(), "sphere", "parts").mean;
         return c.right("sphere", "LDDE") && c.ratio("sphere", "all") < 0.97 &&
                Findings::find(c.f.measured(), "sphere", "all").mean < 0.97 * parts;
     }},
    {"sphere", "LDE",
     "nothing comes by way of a surface that shines itself: a path ends when it meets a lamp",
     [](const Case& c) {
         return c.right("floor") && c.is("sphere", "LDE", 0) && c.right("sphere", "LE");
     }},
    {"mirror", "LDSE",
     "what mirrors show is black: emission that is met after a mirror or glass is never "
     "counted",
     [](const Case& c) { return c.right("floor") && c.is("corridor", "LSSSSSSE", 0); }},
    {"sphere", "LDDDDDE",
     "short paths are right, long ones lose more and more: paths that survive roulette must "
     "count for those that it ended, beta /= q (a missing 1/q)",
     [](const Case& c) {
         return c.right("sphere", "LDDE") && c.ratio("sphere", "LDDDDDE") < 0.9 &&
                c.ratio("corridor", "LSSSSSSE") < 0.95;
     }},
    {"corridor", "LSSSSSSE",
     "long paths by way of mirrors lose light, those by way of paint do not: roulette is not "
     "paid back (1/q) after mirrors and glass",
     [](const Case& c) {
         return c.right("sphere", "LDDDDDE") && c.right("floor") && !c.off("mirror", "LSDE") &&
                c.ratio("corridor", "LSSSSSSE") < 0.97;
     }},
};

/// Weights and cameras: these change what all probes show.
const std::vector<Rule> rules_of_everything = {
    {"room", "LDDE",
     "each path counts as often as there are strategies that find it: the weights are all 1",
     [](const Case& c) {
         return (c.chapter == 21 || c.chapter == 22) && c.ratio("floor") > 1.8 &&
                c.ratio("room", "LDDE") > c.ratio("floor");
     }},
    {"sky", "LDE",
     "direct light counts twice: light sampling finds it, and so do photons, or the ray to the "
     "point where photons are gathered",
     [](const Case& c) {
         return c.by_photons() && c.ratio("floor") > 1.8 && c.ratio("sky") > 1.5;
     }},
    {"sky", "LDE",
     "light that both ways find counts 3/2: what was aimed at counts in full, and what is met "
     "by chance is added to it",
     [](const Case& c) {
         return c.chapter >= 14 && c.ratio("sky") > 1.3 && c.ratio("near") > 1.05;
     }},
    {"corner", "LDE",
     "too dark in the corners of wide pictures, as a power of the cosine there: cosines are "
     "missing in the camera's importance",
     [](const Case& c) { return c.chapter >= 20 && c.ratio("corner") < 0.8; }},
};

/// Factors of f, cosine and density.
const std::vector<Rule> rules_of_factors = {
    {"room", "LDDE", "a factor pi at every diffuse bounce: f is not divided by pi",
     [](const Case& c) {
         return c.is("floor", "LDE", pi_exact) && c.ratio("room", "LDDE") > 1.2 * pi_exact;
     }},
    {"room", "LDDE", "a factor 1/pi at every diffuse bounce: is f divided by pi twice?",
     [](const Case& c) {
         return c.is("floor", "LDE", 1 / pi_exact) && c.ratio("room", "LDDE") < 0.8 / pi_exact;
     }},
    {"floor", "LDE",
     "all that is lit is twice as bright: light that was aimed at is counted again when the "
     "path meets it by chance",
     [](const Case& c) {
         return c.is("floor", "LDE", 2) && c.is("slant", "LDE", 2) && c.is("far", "LDE", 2) &&
                c.is("turned", "LDE", 2);
     }},
    {"slant", "LDE",
     "too bright for light from the side and too dark for light from overhead: the cosine at the "
     "surface is replaced by its average, 1/2",
     [](const Case& c) {
         return c.ratio("floor") > 0.45 && c.ratio("floor") < 0.6 && c.ratio("slant") > 0.9 &&
                c.ratio("slant") < 1.15 && c.right("sky");
     }},
    {"slant", "LDE", "as 1/cos of the angle at the surface: the cosine there is missing",
     [](const Case& c) {
         return c.ratio("floor") < 1.15 && c.ratio("slant") > 1.7 && c.ratio("slant") < 2.4;
     }},
    {"slant", "LDE", "as cos of the angle at the surface: the cosine there is squared",
     [](const Case& c) {
         return c.ratio("floor") > 0.85 && c.ratio("slant") > 0.4 && c.ratio("slant") < 0.6;
     }},
    {"sphere", "LDDE",
     "a factor 2 at every bounce, and under a sky: the density of directions is half of what "
     "they are drawn with (divided by 2 pi, not by pi?)",
     [](const Case& c) { return c.right("floor") && c.is("sphere", "LDDE", 2); }},
    {"sphere", "LDDE",
     "a factor 4/3 at every bounce: directions are drawn by the cosine, but divided by the "
     "uniform density",
     [](const Case& c) { return c.right("floor") && c.is("sphere", "LDDE", 4.0 / 3); }},
    {"sphere", "LDDE",
     "a factor 3/4 or so at every bounce: directions are drawn uniformly, but divided by the "
     "density of the cosine",
     [](const Case& c) { return c.right("floor") && c.is("sphere", "LDDE", 0.75); }},
    {"mirror", "LSDE",
     "right where light comes evenly from everywhere, wrong where it does not: f cos / pdf is "
     "right, but directions are not drawn with that density (is a root missing?)",
     [](const Case& c) {
         return c.chapter < 20 && c.right("floor") && c.right("sphere", "LDDE") && c.right("sky") &&
                (c.off("room", "LDDE") || c.off("mirror", "LSDE"));
     }},
};

/// Choosing lights, and points on them.
const std::vector<Rule> rules_of_lights = {
    {"turned", "LDE",
     "drawn by area, a lamp is as bright from aside as from below: the cosine at the light is "
     "missing in the density",
     [](const Case& c) {
         return c.right("turned") && c.other_off("turned") && c.other->ratio("turned").mean > 1.7;
     }},
    {"turned", "LDE",
     "a lamp is as bright from aside as from below: the cosine at the light is missing",
     [](const Case& c) {
         return c.ratio("floor") < 1.15 && c.ratio("turned") > 1.7 && c.ratio("slant") < 1.3;
     }},
    {"bright", "LDE",
     "ten times the radiance is no brighter: the weight W has p_hat below, but not the sum of "
     "weights over M above (the kept light counts as if drawn with a density of p_hat)",
     [](const Case& c) { return c.ratio("bright") < 0.2 * c.ratio("floor"); }},
    {"horizon", "LDE",
     "a lamp whose middle lies below the horizon lights nothing: p_hat is 0 where its light is "
     "not (the cosines of the centre alone)",
     [](const Case& c) { return c.right("floor") && c.ratio("horizon") < 0.3; }},
    {"three", "LDE",
     "N equal lamps give the light of one: the chance of choosing a light, 1/N (pmf, or W), is "
     "forgotten",
     [](const Case& c) { return c.right("floor") && c.is("three", "LDE", 1.0 / 3); }},
    {"three", "LDE",
     "N equal lamps give N times too much: the chance of choosing a light counts twice",
     [](const Case& c) { return c.right("floor") && c.is("three", "LDE", 3); }},
    {"three", "LDE",
     "of three equal lamps two are included, and each counts once: the sample is not divided by "
     "its "
     "inclusion probability, 2/3",
     [](const Case& c) {
         return c.chapter == 15 && c.right("floor") && c.ratio("three") > 0.6 &&
                c.ratio("three") < 0.75;
     }},
    {"crowd", "LDE",
     "of a thousand lamps only a few are candidates, and each counts for itself alone: the sample "
     "is not divided by how often its light is a candidate",
     [](const Case& c) {
         return c.chapter == 15 && c.right("three") && c.right("unequal") &&
                c.ratio("crowd") > 0.02 && c.ratio("crowd") < 0.5;
     }},
    {"crowd", "LDE",
     "among a thousand lamps the light of weak ones is lost: lights of a small probability are "
     "taken for impossible",
     [](const Case& c) {
         return c.right("three") && c.right("unequal") && c.ratio("crowd") < 0.95;
     }},
    {"unequal", "LDE",
     "equal lamps are right, unequal ones are not: lights are drawn by one distribution and "
     "weighed by another",
     [](const Case& c) { return c.right("three") && c.right("floor") && c.off("unequal"); }},
    {"front", "LDE", "two-sided lamps are half as bright: their density counts one side alone",
     [](const Case& c) { return c.right("floor") && c.is("front", "LDE", 0.5); }},
    {"behind", "LDE",
     "a two-sided lamp lights too little from behind: it is sampled from its front alone",
     [](const Case& c) {
         return c.right("floor") && c.right("front") && c.ratio("behind") < 0.97;
     }},
    {"gap", "leak",
     "light comes through a board just below a lamp: shadow rays end too early, before the "
     "lamp",
     [](const Case& c) { return c.right("half") && c.leaks("gap"); }},
    {"lamp, sky", "LDE",
     "right when the sky is the first light of the file, wrong when it is not: "
     "another light's probability is taken for the sky's",
     [](const Case& c) { return c.right("sky, lamp") && c.off("lamp, sky"); }},
};

/// Normals that are not the surface's own.
const std::vector<Rule> rules_of_normals = {
    {"tiny", "LE",
     "a ball that is nearer than some epsilon is not seen: the sphere test leaves out small t",
     [](const Case& c) { return c.is("tiny", "LE", 0); }},
    {"lamp aside", "LE",
     "a lamp is dark where its bent normal looks away from the camera: which side shines is "
     "the "
     "surface's matter, not the bent normal's",
     [](const Case& c) { return c.off("lamp aside", "LE"); }},
    {"bent mirror", "LSE",
     "a mirror meets itself: the side on which a ray starts is taken from the bent normal, and "
     "must be from the surface's",
     [](const Case& c) { return c.ratio("bent mirror", "LSE") < 0.7 || c.leaks("bent mirror"); }},
    {"below", "leak",
     "light from below the surface: the bent normal alone is asked whether light arrives from "
     "above, the surface's must be, too",
     [](const Case& c) { return c.leaks("below"); }},
    {"below metal", "leak",
     "on rough metal, light from below the surface: the bent normal alone is asked whether "
     "light arrives from above, the surface's must be, too",
     [](const Case& c) { return c.leaks("below metal"); }},
    {"curved", "LDE",
     "normals are right where all corners have the same, wrong where they differ: corners have "
     "each other's normal",
     [](const Case& c) { return c.right("leaning") && c.right("leaning sky") && c.off("curved"); }},
    {"leaning", "LDE",
     "smooth surfaces alone are wrong under a lamp: one of the cosines is that of the "
     "surface's "
     "normal in place of the bent one (or the other way round)",
     [](const Case& c) { return c.right("floor") && c.off("leaning"); }},
    {"leaning mirror", "LSDE",
     "smooth surfaces are right under lamps that are aimed at, wrong in the light of the next "
     "bounce: there the cosine is that of the surface's normal",
     [](const Case& c) {
         return c.right("leaning") && c.right("mirror", "LSDE") && c.off("leaning mirror", "LSDE");
     }},
    {"leaning lamp", "LDE",
     "lamps whose normals lean light too much or too little: their density takes the bent "
     "normal, and must take the surface's",
     [](const Case& c) { return c.right("floor") && c.off("leaning lamp"); }},
    {"leaning sky", "LDE",
     "smooth surfaces alone are wrong under a sky: it is drawn, or its density asked, around "
     "the surface's normal in place of the bent one",
     [](const Case& c) { return c.right("sky") && c.right("leaning") && c.off("leaning sky"); }},
};

/// Glass and metal.
const std::vector<Rule> rules_of_materials = {
    {"in glass", "LSE",
     "seen from inside glass the sky is 1/eta^2 of what it should be: radiance is not squeezed "
     "by eta^2 where it is refracted",
     [](const Case& c) { return c.is("in glass", "LSE", 1 / 2.25); }},
    {"bulb", "LSDE",
     "light from inside glass is off by eta^2: flux is squeezed as if it were radiance",
     [](const Case& c) {
         return c.chapter >= 20 && (c.is("bulb", "LSDE", 2.25) || c.is("bulb", "LSDE", 1 / 2.25));
     }},
    {"pane", "LSE",
     "glass reflects half of what it should: reflection is chosen half as often, but counts "
     "for full",
     [](const Case& c) { return c.is("pane", "LSE", 0.5); }},
    {"metal", "LDE",
     "by the BSDF alone rough metal is much too dark, by aiming it is right: the density of "
     "half vectors is taken for that of directions, 1 / (4 wo.h) is missing",
     [](const Case& c) {
         return c.right("metal") && c.other_off("metal") && c.other->ratio("metal").mean < 0.7;
     }},
    {"metal aslant", "LDE",
     "by the BSDF alone rough metal is too dark along its surface, by aiming it is right: the "
     "share of facets that are hidden, G1, is missing in the density",
     [](const Case& c) {
         return c.right("metal aslant") && c.right("metal") && c.other_off("metal aslant");
     }},
    {"metal aslant", "LDE",
     "rough metal is right from above, too dark along its surface, by every way: f has too "
     "small a G (G1(wo) G1(wi) in place of the G of both)",
     [](const Case& c) {
         return c.ratio("metal aslant") < 0.99 && c.off("metal aslant") && c.off("real metal");
     }},
    {"real metal", "LDE",
     "metal that reflects all is right, metal of real eta and k is not: Fresnel takes another "
     "angle than that to the facet, wo.h",
     [](const Case& c) { return c.right("metal aslant") && c.off("real metal"); }},
};

/// Weights that must sum to 1, and what the later chapters add.
const std::vector<Rule> rules_of_later_chapters = {
    {"bulb", "LSDE",
     "paint is right, light by way of mirrors and glass is too dark: strategies that would "
     "join "
     "a path at a mirror count, though they cannot find it",
     [](const Case& c) {
         return (c.chapter == 21 || c.chapter == 22) && c.right("floor") && c.right("near") &&
                (c.ratio("bulb", "LSDE") < 0.95 || c.ratio("mirror", "LSDE") < 0.95);
     }},
    {"near", "LDE",
     "near lamps alone are off, under a sky all is right: the weights of both ways do not sum "
     "to 1, one takes the light's density per area for that per solid angle",
     [](const Case& c) { return c.chapter >= 14 && c.right("sky") && c.off("near"); }},
    {"sky, lamp", "LDE",
     "one light is right, of several some are off: the weights of both ways do not sum to 1, "
     "one forgets the chance of choosing this light",
     [](const Case& c) {
         return c.chapter >= 14 && c.right("sky") && c.right("near") && c.off("sky, lamp");
     }},
    {"rim", "LE",
     "a blurred point is bright in its middle and dim at its rim: points of the lens crowd in "
     "its middle (is a root missing?)",
     [](const Case& c) { return c.ratio("blur", "LE") > 1.2 && c.off("rim", "LE"); }},
    {"focus", "LE",
     "the corners of a picture are out of focus: the distance of focus counts along the ray, "
     "not along the camera's axis",
     [](const Case& c) { return c.off("focus", "LE"); }},
    {"dispersing", "all",
     "glass that disperses is twice as bright: light of one wavelength counts twice",
     [](const Case& c) { return c.is("dispersing", "all", 2); }},
    {"sky picture", "LDE",
     "under the picture of a sky alone it is off: the density of its directions is "
     "wrong (does it know the solid angle of each pixel?)",
     [](const Case& c) { return c.right("sky") && c.off("sky picture"); }},
    {"floor", "samples", "more samples are taken than were asked for: the pilot counts twice",
     [](const Case& c) { return c.ratio("floor", "samples") > 1.1; }},
    {"rare light", "all",
     "too dark where light is found rarely: a pixel that has missed the light so far decides "
     "for itself to take few samples more",
     [](const Case& c) {
         return c.chapter == 19 && c.off("rare light", "all") &&
                c.ratio("rare light", "all") < 0.97;
     }},
    {"sphere", "rays",
     "the mean is right, but paths are shorter: roulette is played for the first bounces, too",
     [](const Case& c) { return c.ratio("sphere", "rays") < 0.9; }},
    {"red", "noise",
     "the mean is right, but colours are noisy: q must come from the largest channel of beta",
     [](const Case& c) { return c.noisy("red", 1.25); }},
    {"sizes", "noise",
     "the mean is right, but lamps of different sizes are noisy: lights are not chosen by "
     "their "
     "power (is the area in it?)",
     [](const Case& c) { return c.noisy("sizes", 1.5) && !c.noisy("floor", 1.3); }},
};

/// The class that is most surely off, for what no rule explains.
Name largest(const Findings& f) {
    Name name{"", "", "", false};
    double worst = 0;
    for (const auto& [probe, row] : f.expected())
        for (const auto& [path_class, q] : row) {
            if (!is_class(path_class) || !f.off(probe, path_class)) continue;
            Quantity r = f.ratio(probe, path_class);
            double z = std::abs(r.mean - 1) / std::max(r.se, 1e-3);
            if (z <= worst) continue;
            worst = z;
            std::string factor = name_factor(r.mean);
            name = {probe, path_class,
                    factor.empty() ? "no factor that I know" : "a factor " + factor, false};
        }
    return name;
}

}  // namespace

std::string name_factor(double ratio) {
    struct Factor {
        double value;
        const char* text;
    };
    static const std::vector<Factor> factors = {{pi_exact, "pi"},
                                                {1 / pi_exact, "1/pi"},
                                                {2 * pi_exact, "2 pi"},
                                                {0.5 / pi_exact, "1/(2 pi)"},
                                                {4 * pi_exact, "4 pi"},
                                                {0.25 / pi_exact, "1/(4 pi)"},
                                                {2, "2"},
                                                {0.5, "1/2"},
                                                {3, "3"},
                                                {1.0 / 3, "1/3"},
                                                {4, "4"},
                                                {0.25, "1/4"},
                                                {2.25, "eta^2"},
                                                {1 / 2.25, "1/eta^2"},
                                                {1.5, "3/2"},
                                                {2.0 / 3, "2/3"},
                                                {4.0 / 3, "4/3"},
                                                {0.75, "3/4"},
                                                {2 / (3 * pi_exact), "2/(3 pi)"},
                                                {pi_exact * pi_exact, "pi^2"},
                                                {1 / (pi_exact * pi_exact), "1/pi^2"}};
    std::string best;
    double least = 0.04;
    for (const Factor& factor : factors) {
        double distance = std::abs(std::log(ratio / factor.value));
        if (distance < least) least = distance, best = factor.text;
    }
    return best;
}

std::vector<Name> name_mistake(int chapter, const Findings& found, const Findings* other) {
    Case c{chapter, found, other};
    for (const auto* rules :
         {&rules_of_paths, &rules_of_everything, &rules_of_factors, &rules_of_normals,
          &rules_of_lights, &rules_of_materials, &rules_of_later_chapters}) {
        for (const Rule& rule : *rules) {
            if (found.has(rule.probe) && rule.applies(c))
                return {{rule.probe, rule.path_class, rule.text}};
        }
    }
    for (const Findings* f : {&found, other}) {
        if (!f) continue;
        Name name = largest(*f);
        if (!name.probe.empty()) return {name};
    }
    return {};
}
