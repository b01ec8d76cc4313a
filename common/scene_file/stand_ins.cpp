#include "common/scene_file/stand_ins.h"

const std::vector<StandIn>& all_stand_ins() {
    static const std::vector<StandIn> all = {
        {"Material \"coatedconductor\"", "the metal under the coat"},
        {"Material \"coateddiffuse\"", "diffuse"},
        {"Material \"diffusetransmission\"", "diffuse, without the light that passes"},
        {"Material \"hair\"", "diffuse"},
        {"Material \"measured\"", "diffuse"},
        {"Material \"mix\"", "diffuse"},
        {"Material \"subsurface\"", "diffuse"},
        {"Material \"thindielectric\"", "nothing: light passes"},
        {"rough glass", "smooth glass"},
        {"a roughness that differs between u and v", "their geometric mean"},
        {"a spectrum that is not known", "the default of its parameter"},
        {"a bump or normal map", "none"},
        {"alpha", "1, or nothing where it is 0 everywhere"},
        {"a texture that is no reflectance", "the default of its parameter"},
        {"Texture \"bilerp\"", "grey (0.5)"},
        {"Texture \"directionmix\"", "grey (0.5)"},
        {"Texture \"dots\"", "grey (0.5)"},
        {"Texture \"marble\"", "grey (0.5)"},
        {"Texture \"mix\"", "grey (0.5)"},
        {"Texture \"ptex\"", "grey (0.5)"},
        {"a checkerboard of 3 dimensions", "its mean"},
        {"a mapping other than \"uv\"", "the mean of the texture"},
        {"a textured mesh without usable uv", "the mean of the texture"},
        {"a picture that cannot be read", "grey (0.5)"},
        {"a mesh that cannot be read", "nothing"},
        {"a scene file that cannot be read", "nothing"},
        {"Shape \"curve\"", "nothing"},
        {"Shape \"cylinder\"", "nothing"},
        {"Shape \"loopsubdiv\"", "its control mesh"},
        {"a part of a sphere or disk", "the whole"},
        {"a sphere or disk scaled differently along its axes", "one of their mean size"},
        {"a light or camera that moves", "one that rests as when the shutter opens"},
        {"TransformTimes", "0 1"},
        {"LightSource \"goniometric\"", "a point light"},
        {"LightSource \"projection\"", "a point light"},
        {"LightSource \"spot\"", "a point light"},
        {"an image on an area light", "its L alone"},
        {"the illuminance of a picture of the sky", "the picture as it is"},
        {"a portal", "none: the light comes from everywhere"},
        {"a second picture of the sky", "grey (0.5)"},
        {"a scene without shapes", "its lights alone"},
        {"a scene without light", "a grey sky (0.5)"},
        {"Camera \"orthographic\"", "a perspective one from far away"},
        {"Camera \"realistic\"", "a pinhole camera of 40 degrees"},
        {"Camera \"spherical\"", "a perspective camera of 90 degrees"},
        {"Film \"gbuffer\"", "\"rgb\""},
        {"Film \"spectral\"", "\"rgb\""},
        {"a part of the film", "the whole"},
        {"a sensor or white balance", "\"cie1931\""},
        {"MakeNamedMedium", "empty space"},
        {"a lens, in a chapter without one", "a pinhole"},
        {"glass that disperses, in a chapter without it", "glass of one index"},
        {"a shape that moves, in a chapter where all rest", "one that rests at its start"},
        {"a picture of the sky, in a chapter without one", "a sky of its mean color"},
    };
    return all;
}

std::string or_stand_in(const std::string& what) {
    for (const StandIn& stand_in : all_stand_ins()) {
        if (stand_in.what == what) return "; --stand-in renders it as " + stand_in.instead;
    }
    return "";
}
