// All parameters of directives, with what they may be; and what stands in for what is not modelled.
#include "common/scene_file/params.h"

namespace {

constexpr double inf = double{infinity};
constexpr const char* cameras = "perspective orthographic realistic spherical";
constexpr const char* films = "rgb gbuffer spectral";
constexpr const char* filters = "box gaussian mitchell sinc triangle";
constexpr const char* samplers = "halton independent paddedsobol pmj02bn sobol stratified zsobol";
constexpr const char* integrators =
    "ambientocclusion bdpt lightpath mlt path randomwalk simplepath simplevolpath sppm volpath";
constexpr const char* reflecting =
    "diffuse conductor coatedconductor coateddiffuse diffusetransmission hair measured mix "
    "subsurface";
constexpr const char* bare = "dielectric interface none thindielectric";
constexpr const char* points = "point spot goniometric projection";
constexpr const char* meshes = "trianglemesh bilinearmesh loopsubdiv";
constexpr const char* shapes =
    "sphere disk plymesh trianglemesh bilinearmesh loopsubdiv curve cylinder";
constexpr const char* mapped = "imagemap checkerboard";
constexpr const char* ignored = "bool or float or integer or string";  // changes nothing

constexpr ParamRow rows[] = {
    {"Camera", cameras, "float", "fov", 90, 0.001, 179.999},
    {"Camera", cameras, "float", "frameaspectratio", 1, 1e-4, 1e4},
    {"Camera", cameras, "float", "screenwindow", 0, -1e4, 1e4, 4},
    {"Camera", cameras, "float", "lensradius", 0, 0, 1e6},
    {"Camera", cameras, "float", "focaldistance", 1e6, 0, 1e9},
    {"Camera", cameras, "float", "shutteropen", 0},
    {"Camera", cameras, "float", "shutterclose", 1},

    {"Film", films, "integer", "xresolution", 1280, 1, 1 << 16},
    {"Film", films, "integer", "yresolution", 720, 1, 1 << 16},
    {"Film", films, "float", "maxcomponentvalue"},
    {"Film", films, "", "iso sensor whitebalance", 0, 0, 0, 0, "the film's response"},
    {"Film", films, "", "cropwindow pixelbounds", 0, 0, 0, 0, "a part of the film"},
    {"Film", films, ignored, "diagonal filename savefp16"},

    {"PixelFilter", filters, "float", "xradius yradius", 0.5},
    {"PixelFilter", filters, ignored, "B C sigma tau"},

    {"Sampler", "stratified", "integer", "xsamples ysamples", 4, 1, 1 << 12},
    {"Sampler", "independent", "integer", "pixelsamples", 4, 1, 1 << 24},
    {"Sampler", "halton paddedsobol pmj02bn sobol zsobol", "integer", "pixelsamples", 16, 1,
     1 << 24},
    {"Sampler", samplers, ignored, "jitter randomization seed"},

    {"Integrator", integrators, "integer", "maxdepth", 5, 0, 1 << 30},
    {"Integrator", integrators, ignored,
     "bootstrapsamples chains cossample largestepprobability lightsampler maxdistance "
     "mutationsperpixel photonsperiteration radius regularize rrthreshold samplebsdf samplelights "
     "seed sigma visualizestrategies visualizeweights"},

    {"Material", reflecting, "rgb or texture", "reflectance", 0.5, 0, 1},
    {"Material", "conductor", "rgb or spectrum", "eta k", 0, 0, 1e4},
    {"Material", "coatedconductor", "rgb or spectrum", "conductor.eta conductor.k", 0, 0, 1e4},
    {"Material", "dielectric", "float or spectrum", "eta", 1.5, 1e-4, 1e4},
    {"Material", "conductor dielectric", "float", "roughness uroughness vroughness", 0, 0, 100},
    {"Material", "coatedconductor", "float",
     "conductor.roughness conductor.uroughness conductor.vroughness", 0, 0, 100},
    {"Material", "conductor coatedconductor dielectric", "bool", "remaproughness", 1},
    {"Material", reflecting, "", "displacement normalmap", 0, 0, 0, 0, "a bump or normal map"},
    {"Material", bare, "", "displacement normalmap", 0, 0, 0, 0, "a bump or normal map"},

    {"AreaLightSource", "diffuse", "", "filename", 0, 0, 0, 0, "an image on an area light"},
    {"AreaLightSource", "diffuse", "rgb or blackbody", "L", 1, 0},
    {"AreaLightSource", "diffuse", "float", "scale", 1, 0},
    {"AreaLightSource", "diffuse", "float", "power"},
    {"AreaLightSource", "diffuse", "bool", "twosided"},

    {"LightSource", points, "rgb or blackbody", "I", 1, 0},
    {"LightSource", points, "float", "scale", 1, 0},
    {"LightSource", points, "float", "power"},
    {"LightSource", points, "point3", "from"},
    {"LightSource", "distant infinite", "rgb or blackbody", "L", 1, 0},
    {"LightSource", "distant infinite", "float", "scale", 1, 0},
    {"LightSource", "distant infinite", "float", "illuminance"},
    {"LightSource", "distant", "point3", "from to"},
    {"LightSource", "infinite", "string", "filename"},
    {"LightSource", "infinite", "", "portal", 0, 0, 0, 0, "a portal"},

    {"Shape", "sphere disk", "float", "radius", 1, 1.1e-19},  // the square of a smaller one is 0
    {"Shape", "sphere disk", "float", "phimax", 360},
    {"Shape", "sphere", "float", "zmin zmax"},
    {"Shape", "disk", "float", "height innerradius"},
    {"Shape", "plymesh", "string", "filename"},
    {"Shape", shapes, "", "alpha", 0, 0, 0, 0, "alpha"},
    {"Shape", shapes, "", "displacement displacement.edgelength edgelength", 0, 0, 0, 0,
     "a bump or normal map"},
    {"Shape", shapes, "", "emissionfilename", 0, 0, 0, 0, "an image on an area light"},
    {"Shape", meshes, "point3", "P", 0, -inf, inf, 0},
    {"Shape", meshes, "normal", "N", 0, -inf, inf, 0},
    {"Shape", meshes, "vector3", "S", 0, -inf, inf, 0},
    {"Shape", meshes, "point2", "uv", 0, -inf, inf, 0},
    {"Shape", meshes, "integer", "indices faceIndices", 0, -inf, inf, 0},

    {"Texture", "bilerp directionmix dots marble mix ptex scale", "", ""},
    {"Texture", "constant", "rgb", "value", 1, 0, 1},
    {"Texture", "checkerboard", "rgb or texture", "tex1", 1, 0, 1},
    {"Texture", "checkerboard", "rgb or texture", "tex2", 0, 0, 1},
    {"Texture", "checkerboard", "integer", "dimension", 2, 2, 3},
    {"Texture", mapped, "string", "mapping"},
    {"Texture", mapped, "float", "uscale vscale", 1, -1e9, 1e9},
    {"Texture", mapped, "float", "udelta vdelta", 0, -1e9, 1e9},
    {"Texture", mapped, "vector3", "v1 v2"},
    {"Texture", "imagemap", "string", "encoding filename filter wrap"},
    {"Texture", "imagemap", "float", "scale", 1, 0, 1e9},
    {"Texture", "imagemap", ignored, "maxanisotropy"},
    {"Texture", "imagemap", "bool", "invert"},
};

}  // namespace

const std::map<std::string, std::map<std::string, KnownParams>>& known_params() {
    static const auto all = [] {
        std::map<std::string, std::map<std::string, KnownParams>> map;
        map["Material"][""];  // the same as "none"
        for (const ParamRow& row : rows) {
            for (const std::string& kind : words_of(row.kinds)) {
                KnownParams& known = map[row.directive][kind];
                for (const std::string& name : words_of(row.names)) known[name] = &row;
            }
        }
        return map;
    }();
    return all;
}

const std::map<std::string, std::string>& all_stand_ins() {
    // A directive and types of it, or nothing and a name; and what is rendered instead.
    static constexpr const char* known[][3] = {
        {"Camera", "orthographic realistic spherical", "a perspective camera of 90 degrees"},
        {"Film", "gbuffer spectral", "\"rgb\""},
        {"LightSource", "goniometric projection spot", "a point light"},
        {"Material", "coateddiffuse hair measured mix subsurface", "diffuse"},
        {"Material", "coatedconductor", "the metal under the coat"},
        {"Material", "diffusetransmission", "diffuse, without the light that passes"},
        {"Material", "thindielectric", "nothing: light passes"},
        {"Shape", "curve cylinder", "nothing"},
        {"Shape", "loopsubdiv", "its control mesh"},
        {"Texture", "bilerp directionmix dots marble mix ptex scale", "grey (0.5)"},
        {"", "MakeNamedMedium", "empty space"},
        {"", "TransformTimes", "0 1"},
        {"", "CoordSysTransform", "the current transform"},
        {"", "rough glass", "smooth glass"},
        {"", "a roughness that differs between u and v", "their geometric mean"},
        {"", "a spectrum that is not known", "the default of its parameter"},
        {"", "a bump or normal map", "none"},
        {"", "alpha", "1, or nothing where it is 0 everywhere"},
        {"", "a texture that is no reflectance", "the default of its parameter"},
        {"", "a checkerboard of 3 dimensions", "grey (0.5)"},
        {"", "a mapping other than \"uv\"", "grey (0.5)"},
        {"", "a wrap other than \"repeat\"", "\"repeat\""},
        {"", "a textured mesh without usable uv", "grey (0.5)"},
        {"", "a picture that cannot be read", "grey (0.5)"},
        {"", "a mesh that cannot be read", "nothing"},
        {"", "a scene file that cannot be read", "nothing"},
        {"", "a part of a sphere or disk", "the whole"},
        {"", "a sphere or disk scaled differently along its axes", "one scaled as its x axis is"},
        {"", "a light or camera that moves", "one that rests as when the shutter opens"},
        {"", "an image on an area light", "its L alone"},
        {"", "the illuminance of a picture of the sky", "the picture as it is"},
        {"", "a portal", "none: the light comes from everywhere"},
        {"", "a scene without shapes", "its lights alone"},
        {"", "a scene without light", "a grey sky (0.5)"},
        {"", "a part of the film", "the whole"},
        {"", "the film's response", "that of \"cie1931\" at iso 100"},
        {"", "a lens, in a chapter without one", "a pinhole"},
        {"", "glass that disperses, in a chapter without it", "glass of one index"},
        {"", "a shape that moves, in a chapter where all rest", "one that rests at its start"},
        {"", "a picture of the sky, in a chapter without one", "a sky of its mean color"},
    };
    static const auto all = [] {
        std::map<std::string, std::string> map;
        for (auto [directive, what, instead] : known) {
            if (!*directive) map[what] = instead;
            for (const std::string& type : words_of(*directive ? what : "")) {
                map[std::string(directive) + ' ' + quote(type)] = instead;
            }
        }
        return map;
    }();
    return all;
}

std::string or_stand_in(const std::string& what) {
    auto found = all_stand_ins().find(what);
    return found == all_stand_ins().end() ? "" : "; --stand-in renders it as " + found->second;
}
