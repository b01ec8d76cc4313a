#include "tests/known/scenes.h"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/base/error.h"
#include "common/base/files.h"
#include "tests/known/words.h"

namespace {

std::string view(const std::string& look_at, const std::string& camera = "\"float fov\" 40",
                 int max_depth = 1, int width = 16) {
    return format(
               "Film \"rgb\" \"integer xresolution\" %d \"integer yresolution\" 16\n"
               "PixelFilter \"box\" Integrator \"path\" \"integer maxdepth\" %d\n",
               width, max_depth) +
           "LookAt " + look_at + "\nCamera \"perspective\" " + camera + "\nWorldBegin\n";
}
/// Straight down on the floor's middle.
std::string from_above(double height, int max_depth = 1) {
    return view(format("0 %g 0  0 0 0  0 0 1", height), "\"float fov\" 40", max_depth);
}
std::string floor_of(const std::string& material, const std::string& normals = "",
                     double half_side = 20) {
    return group(material + scale(half_side) + square(true, normals));
}
/// A black square lamp of the side 1, with its middle at the origin, that shines down.
std::string lamp(const std::string& place, double L = 1, bool two_sided = false, bool up = false) {
    return group(shining(L, two_sided) + paint(0) + place + scale(0.5) + square(up));
}
std::string sky(double L = 1) {
    return format("LightSource \"infinite\" \"rgb L\" [%g %g %g]\n", L, L, L);
}

const std::string floor_here = floor_of(paint(0.5));
const std::string above = from_above(1.2);
/// The place of a lamp at distance 2, this far from overhead, that faces the floor's middle.
std::string tilted(double degrees) { return turn(degrees, z_axis) + at(0, 2, 0); }

/// The same lamp near the floor, whose normals lean in all directions.
const std::string bent_lamp =
    "Shape \"trianglemesh\" \"integer indices\" [0 1 4 1 2 4 2 3 4 3 0 4] \"point3 P\" "
    "[-.5 .4 -.5  .5 .4 -.5  .5 .4 .5  -.5 .4 .5  0 .4 0] \"normal N\" "
    "[2 -1 0  0 -1 2  1 -1 1  -1 -1 2  1.5 -1 -1]\n";

/// The inside of a cube of side 2.
std::string cube(const std::string& material) {
    std::string faces;
    for (double angle : {0.0, 90.0, 180.0, 270.0})
        faces += group(turn(angle, z_axis) + at(0, -1, 0) + square(true));
    for (double angle : {90.0, -90.0})
        faces += group(turn(angle, x_axis) + at(0, -1, 0) + square(true));
    return material + faces;
}

/// A lamp of 35 x 35 small ones.
std::string crowd() {
    std::string text;
    for (int i = 0; i < 35; i++)
        for (int k = 0; k < 35; k++)
            text += lamp(at(-0.85 + 0.05 * i, 1, -0.85 + 0.05 * k) + scale(0.045), 1);
    return text;
}

void add_floors(std::vector<KnownScene>& p) {
    p.push_back({"floor", "a floor under a lamp", above + floor_here + lamp(at(0, 2, 0))});
    p.push_back(
        {"slant", "a lamp 60 degrees from overhead", above + floor_here + lamp(tilted(60))});
    p.push_back({"turned", "a lamp overhead that is turned away by 60 degrees",
                 above + floor_here + lamp(at(0, 2, 0) + turn(60, z_axis))});
    p.push_back({"far", "a lamp of 2 x 2, twice as far",
                 above + floor_here + lamp(at(0, 4, 0) + scale(2))});
    p.push_back({"large", "a lamp of 2 x 2", above + floor_here + lamp(at(0, 2, 0) + scale(2))});
    p.push_back(
        {"bright", "a lamp ten times as bright", above + floor_here + lamp(at(0, 2, 0), 10)});
    p.push_back({"near", "a lamp just above", from_above(0.1) + floor_here + lamp(at(0, 0.2, 0))});
    p.push_back({"three", "three lamps, all alike and as far",
                 above + floor_here + lamp(at(1, 2, 0)) + lamp(at(-0.5, 2, 0.866)) +
                     lamp(at(-0.5, 2, -0.866))});
    p.push_back({"unequal", "a strong lamp and a weak one",
                 above + floor_here + lamp(at(-1, 2, 0), 20) + lamp(at(1, 2, 0) + scale(1.3), 1)});
    p.push_back(
        {"crowd", "a thousand weak lamps", from_above(0.8) + floor_here + crowd(), 9, 21, 16});
    p.push_back(
        {"sizes", "a large lamp and a tiny one",
         above + floor_here + lamp(at(0, 2, 0) + scale(2)) + lamp(at(1.5, 2, 0) + scale(0.02))});
    p.push_back({"front", "a two-sided lamp, from its front",
                 above + floor_here + lamp(at(0, 2, 0), 1, true)});
    p.push_back({"behind", "a two-sided lamp, from behind",
                 above + floor_here + lamp(at(0, 2, 0), 1, true, true)});
    p.push_back({"half", "a board that hides half of a lamp",
                 from_above(0.6) + floor_here + lamp(at(0, 2, 0)) +
                     group(paint(0) + at(1, 1, 0) + square(true))});
    p.push_back({"gap", "a board just below a lamp",
                 from_above(0.6) + floor_here + lamp(at(0, 1, 0)) +
                     group(paint(0) + at(0, 0.9999, 0) + scale(0.6) + square(false))});
    p.push_back({"horizon", "a lamp of which the floor cuts off the larger part",
                 above + floor_here + lamp(at(-1, -0.5, 0) + turn(90, z_axis) + scale(2), 1)});
}

/// What the vertex before has to be remembered for: the camera sees a board, and in it or by its
/// light a floor close under a lamp. There the weights of both strategies are near 1/2.
void add_second_vertices(std::vector<KnownScene>& p) {
    auto board = [](const std::string& material) {
        return view("-0.4 0.1 0  1 0.1 0  0 1 0", "\"float fov\" 10", 4) + floor_here +
               lamp(at(0, 0.2, 0)) +
               group(material + at(0.7, 0.5, 0) + turn(90, z_axis) + scale(0.5) + square(true));
    };
    std::string more = lamp(at(0, 1.5, 1.2), 0.3) + lamp(at(0, 1.5, -1.2), 0.1);
    p.push_back({"wall-beside", "a wall beside a floor close under a lamp", board(paint(0.5))});
    p.push_back({"mirror-beside", "a mirror beside a floor close under a lamp", board(metal(0.9))});
    p.push_back({"metal-beside", "rough metal beside a floor close under one of three lamps",
                 board(metal(0.9, smoother)) + more, 13});
}

std::string shining_sphere(const std::string& material, int max_depth) {
    return view("0 0 0  0 0 1  0 1 0", "\"float fov\" 60", max_depth) +
           group("ReverseOrientation " + shining(1) + material + ball(1));
}
std::string room(int max_depth) {
    return view("0 0 -0.95  0 0 0  0 1 0", "\"float fov\" 80", max_depth) +
           group(cube(paint(0.5))) + lamp(at(0, 0.99, 0));
}

void add_skies(std::vector<KnownScene>& p) {
    std::string wide = floor_of(paint(0.5), "", 500);
    std::string low = from_above(0.5);
    // So small that paths from the sky meet it.
    std::string small_floor = floor_of(paint(0.5), "", 0.6);
    p.push_back({"sky", "a floor under a white sky", low + small_floor + sky(), 7, 21, 256});
    p.push_back({"sky-lamp", "a sky, and behind it in the list a lamp",
                 low + wide + sky() + lamp(at(0, 1, 0), 5)});
    p.push_back({"lamp-sky", "a lamp, and behind it in the list the sky",
                 low + wide + lamp(at(0, 1, 0), 5) + sky()});
    p.push_back({"sphere", "the inside of a sphere that shines and reflects half",
                 shining_sphere(paint(0.5), 6), 7, 21, 256});
    // Before chapter 10 its long paths are too noisy, and from 21 on they have too many
    // connections.
    p.push_back({"red", "the inside of a shining red sphere",
                 shining_sphere("Material \"diffuse\" \"rgb reflectance\" [0.97 0.02 0.02] ", 60),
                 10, 20, 16});
    p.push_back({"room", "a grey room with a lamp", room(3), 7, 21, 128});
    p.push_back({"box", "a closed box in a bright sky",
                 view("1000 300 0  1001 300 1  0 1 0", "\"float fov\" 60", 4) + sky() +
                     group(at(1000, 300, 0) + "Rotate 33 1 2 3 " + cube(paint(0.8)))});
}

/// What lights there are besides squares and skies. No light without a size is found by chance.
void add_kinds_of_lights(std::vector<KnownScene>& p) {
    std::string small_floor = floor_of(paint(0.5), "", 2);
    std::string point = "LightSource \"point\" \"rgb I\" [1 1 1] \"point3 from\" [0.6 1.5 0.3]\n";
    std::string sun =
        "LightSource \"distant\" \"rgb L\" [1 1 1] \"point3 from\" [1 2 0.5] \"point3 to\" [0 0 "
        "0]\n";
    std::string down = turn(90, x_axis), disk = "Shape \"disk\" \"float radius\" 0.5\n";
    auto shape = [](const std::string& place, const std::string& what) {
        return group(shining(1) + paint(0) + place + what);
    };
    p.push_back(
        {"point", "a floor under a point light that is under a black ceiling",
         above + small_floor + point + group(paint(0) + at(0, 1.6, 0) + scale(2) + square(false)),
         9});
    p.push_back({"sun", "a floor under a distant light", above + small_floor + sun, 9});
    p.push_back({"kinds", "a floor under a lamp, a point light and a distant light",
                 above + small_floor + lamp(at(0, 2, 0), 5) + point + sun, 9});
    p.push_back({"metal-point", "rough metal under a point light",
                 view("-1 0.5 0  0 0 0  0 1 0", "\"float fov\" 5") +
                     floor_of(metal(1, rough), "", 2) + point,
                 13});
    p.push_back({"disk", "a floor under a disk that shines",
                 above + floor_here + shape(at(0.5, 2, 0) + down, disk)});
    p.push_back({"near-disk", "a floor close under a disk that shines",
                 from_above(0.1) + floor_here + shape(at(0, 0.2, 0) + down, disk)});
    p.push_back({"shining-ball", "a floor under a ball that shines",
                 above + floor_here + shape(at(0.5, 2, 0), ball(0.5))});
}

void add_bent(std::vector<KnownScene>& p) {
    std::string bent = floor_of(paint(0.5), leaning(40));
    // Of each triangle the camera sees what is near one corner.
    std::string curved = group(paint(0.5) + scale(4) + at(0.9, 0, 0) +
                               square(true, "-1.5 1 0  0 1 0  1.5 1 0  0 1 0"));
    std::string strip = lamp(tilted(-30));
    p.push_back({"leaning", "a floor whose normals lean, under a lamp", above + bent + strip});
    p.push_back(
        {"curved", "a floor whose normals differ from corner to corner", above + curved + strip});
    p.push_back(
        {"leaning-sky", "a floor whose normals lean, under a sky", from_above(0.5) + bent + sky()});
    p.push_back({"away", "a floor whose normals lean away from the camera",
                 view("-1 0.45 0  0 0 0  0 1 0", "\"float fov\" 20") + bent + lamp(at(0, 2, 0))});
    p.push_back({"leaning-mirror", "a floor whose normals lean, lit through a mirror",
                 from_above(0.5, 2) + bent + lamp(at(-1.5, 1, 0) + scale(2), 1, false, true) +
                     group(metal(1) + at(-1.5, 2, 0) + scale(4) + square(false))});
    p.push_back({"leaning-lamp", "a lamp of four triangles whose normals lean",
                 above + floor_here + group(shining(1) + paint(0) + at(0, 1.1, 0) + bent_lamp), 7,
                 21, 256});
    p.push_back({"lamp-aside", "a lamp whose normals lean away from the camera",
                 view("-3 -1 0  0 0 0  0 1 0", "\"float fov\" 3") +
                     group(shining(1) + paint(0) + scale(2) + square(false, leaning(80, false)))});
    // Below them is a lamp, and a floor that it lights; neither should be seen from above.
    std::string under = lamp(turn(-110, z_axis) + at(0, 2, 0), 1000, true) +
                        group(at(0, -4, 0) + floor_of(paint(0.8), "", 19));
    std::string above_two = from_above(1.2, 3);
    p.push_back(
        {"below", "a floor whose normals lean, over a lamp below it", above_two + bent + under});
    std::string bent_metal = floor_of(metal(1, rough), leaning(40));
    p.push_back({"below-metal", "rough metal whose normals lean, over a lamp below it",
                 above_two + bent_metal + under, 13});
    p.push_back({"bent-mirror", "a mirror whose normals lean towards its horizon",
                 view("-3 1.73 0  0 0 0  0 1 0", "\"float fov\" 3", 4) + sky() +
                     floor_of(metal(1), leaning(20))});
}

void add_glass_and_metal(std::vector<KnownScene>& p) {
    const std::string row =
        view("0 0 0  1 0 0.16  0 1 0", "\"float fov\" 0.5", 12) + sky() +
        group(metal(0.9) + at(1, 0, 0) + turn(90, z_axis) + "Scale 20 1 1.86 " + square(true)) +
        group(metal(0.9) + at(-1, 0, 0) + turn(-90, z_axis) + "Scale 20 1 1.86 " + square(true));
    const std::string upright = turn(90, x_axis) + scale(200);  // faces +z
    p.push_back({"corridor", "the sky in a row of six mirrors", row});
    p.push_back({"window", "the sky in a row of six mirrors that ends at a pane of glass",
                 row + group(glass + at(0, 0, 2.1) + upright + square(true)) +
                     group(glass + at(0, 0, 2) + upright + square(false)) +
                     group(paint(0) + at(0, 0, -3) + upright + square(true))});
    p.push_back(
        {"pane", "a ball of glass before a sky",
         view("0 0 -4  0.9 0 0  0 1 0", "\"float fov\" 1", 6) + sky() + group(glass + ball(1))});
    p.push_back(
        {"in-glass", "the sky seen from inside a ball of glass",
         view("0.5 0 0  0.5 0 1  0 1 0", "\"float fov\" 20", 6) + sky() + group(glass + ball(1))});
    p.push_back({"bulb", "a lamp in a ball of glass",
                 from_above(0.4, 3) + floor_here + group(at(0, 1.5, 0) + glass + ball(1)) +
                     group(shining(1) + paint(0) + at(0, 1.5, 0) + ball(0.3)),
                 7, 21, 128});
    p.push_back({"mirror", "a floor lit through a mirror",
                 from_above(0.5, 2) + floor_here + lamp(at(1.5, 1, 0) + scale(2), 1, false, true) +
                     group(metal(1) + at(1.5, 2, 0) + scale(4) + square(false))});
    p.push_back({"tiny", "a shining ball of a hundredth of a millimetre, from near",
                 view("0 0 -4e-5  0 0 0  0 1 0", "\"float fov\" 20") +
                     group(shining(1) + paint(0) + ball(1e-5))});
    auto on_metal = [&](const std::string& material, double height) {
        return view(format("-1 %g 0  0 0 0  0 1 0", height), "\"float fov\" 5") + sky() +
               floor_of(material);
    };
    p.push_back({"metal-wall", "rough metal that shows a wall under a sky",
                 view("-1 0.5 0  0 0 0  0 1 0", "\"float fov\" 5", 2) + sky() +
                     floor_of(metal(1, smoother)) +
                     group(paint(0.5) + at(1, 0, 0) + turn(90, z_axis) + scale(3) + square(true)),
                 13});
    p.push_back({"metal", "rough metal, from above", on_metal(metal(1, rough), 8), 13});
    p.push_back({"metal-at-an-angle", "rough metal, along its surface",
                 on_metal(metal(1, rough), 0.25), 13});
    std::string real =
        "Material \"conductor\" \"rgb eta\" [1.5 1.5 1.5] \"rgb k\" [1 1 1] " + rough + "\n";
    p.push_back({"real-metal", "rough metal of real eta and k, along its surface",
                 on_metal(real, 0.25), 13});
}

/// Cameras with a lens, wide ones, and an open shutter.
void add_cameras(std::vector<KnownScene>& p) {
    p.push_back({"corner", "the corner of a wide picture of a floor",
                 view("0 1.2 0  0 0 0  0 0 1",
                      "\"float fov\" 90 \"float screenwindow\" [0.8 1.2 0.8 1.2]") +
                     floor_here + lamp(at(1, 2, 1) + scale(2))});
    auto lens = [](const char* window) {
        return view("0 0 -4  0 0 0  0 1 0",
                    format("\"float fov\" 90 \"float screenwindow\" [%s] \"float lensradius\" 0.2 "
                           "\"float focaldistance\" 2",
                           window));
    };
    std::string point = group(shining(1) + paint(0) + ball(0.01));
    // The ball is a disk of the radius 0.05 on the screen at distance 1.
    p.push_back({"blur", "the middle of a blurred lamp", lens("-0.01 0.01 -0.01 0.01") + point, 16,
                 19, 1024});
    p.push_back({"rim", "the rim of a blurred lamp", lens("0.035 0.047 -0.006 0.006") + point, 16,
                 19, 1024});
    p.push_back({"focus", "a lamp in focus, in the corner of a wide picture",
                 view("0 0 0  0 0 1  0 1 0",
                      "\"float fov\" 90 \"float screenwindow\" [0.98 1.02 0.98 1.02] "
                      "\"float lensradius\" 0.3 \"float focaldistance\" 4") +
                     group(shining(1) + paint(0) + at(-4, 4, 4) + turn(-90, x_axis) + scale(0.12) +
                           square(true)) +
                     group(shining(1) + paint(0) + at(4, 4, 4) + turn(-90, x_axis) + scale(0.12) +
                           square(true)),
                 16, 19});
    std::string moving = floor_here + lamp(at(0, 2, 0)) +
                         group(paint(0) + at(-1.4, 1.6, 0) + "ActiveTransform EndTime " +
                               at(1.6, 0, 0) + "ActiveTransform All " + scale(0.5) + square(false));
    p.push_back({"moving", "a floor in the shadow of a board that moves", above + moving, 16});
    p.push_back({"moving-lens", "the same floor, through a lens",
                 view("0 1.2 0  0 0 0  0 0 1",
                      "\"float fov\" 40 \"float lensradius\" 0.1 \"float focaldistance\" 1.2") +
                     moving,
                 16, 19});
}

/// What chapters 17 to 19 are about.
void add_wavelengths_and_shares(std::vector<KnownScene>& p) {
    p.push_back({"dispersing", "a ball of glass that disperses, before a white sky",
                 view("0 0 -4  0 0 0  0 1 0", "\"float fov\" 20", 20) + sky() +
                     group("Material \"dielectric\" \"spectrum eta\" \"glass-F11\" " + ball(1)),
                 18, 19});
    p.push_back({"sky-picture", "a floor under the picture of a sky",
                 from_above(0.5) +
                     group(turn(-90, x_axis) +
                           "LightSource \"infinite\" \"string filename\" \"scenes/sky.pfm\"\n") +
                     floor_of(paint(0.5), "", 0.6),
                 17});
    p.push_back({"rare-light", "a floor on which light is found rarely",
                 from_above(0.5, 2) + floor_here +
                     lamp(at(1.5, 1, 0) + scale(0.15), 100, false, true) +
                     group(metal(1) + at(1.5, 2, 0) + scale(4) + square(false)),
                 19, 19, 512});
}

/// Other sizes, other distances, and several things at once: where one thing alone is right.
void add_combinations(std::vector<KnownScene>& p) {
    p.push_back({"small", "a lamp of a centimetre just above a floor",
                 from_above(0.001) + scale(0.01) + floor_here + lamp(at(0, 0.2, 0))});
    p.push_back({"great", "a board of two kilometres that hides half of a lamp",
                 from_above(600) + scale(1000) + floor_here + lamp(at(0, 2, 0)) +
                     group(paint(0) + at(1, 1, 0) + square(true))});
    std::string sun =
        "LightSource \"distant\" \"rgb L\" [1 1 1] \"point3 from\" [1 2 0] \"point3 to\" [0 0 0]\n";
    std::string small_floor = floor_of(paint(0.5), "", 0.5);
    p.push_back({"far-board", "a small floor in the shadow of boards far above it",
                 from_above(1) + small_floor + sun + sky() +
                     group(paint(0) + at(10.3, 20, 0) + scale(0.5) + square(false)) +
                     group(paint(0) + at(-9, 9, 0) + scale(9) + square(false)),
                 9, 19});
    auto color = [](const char* rgb) {
        return format("Material \"diffuse\" \"rgb reflectance\" [%s]\n", rgb);
    };
    p.push_back({"pure-colors", "a corner that reflects red and blue, or red and green",
                 view("0 1.8 0  -0.3 0 0  0 0 1", "\"float fov\" 60", 3) +
                     floor_of(color("0.8 0 0.4"), "", 1) +
                     group(color("0.9 0.6 0") + at(-1, 1, 0) + turn(-90, z_axis) + square(true)) +
                     lamp(at(0.5, 1.5, 0))});
    std::string row;
    for (double x : {-2.2, -1.1, 0.0, 1.1, 2.2}) row += lamp(at(x, 0.3, 0), 1 + 0.3 * x);
    p.push_back({"row", "a floor close under five lamps", from_above(0.25) + floor_here + row});
    p.push_back({"metal-row", "rough metal close under five lamps",
                 view("-0.5 0.25 0  0 0 0  0 1 0") + floor_of(metal(0.9, rough)) + row, 13});
    std::string point = "LightSource \"point\" \"rgb I\" [1 1 1] \"point3 from\" [-0.4 0.8 0.3]\n";
    std::string two_walls = floor_of(paint(0.5), "", 1) +
                            group(paint(0.7) + at(-1, 1, 0) + turn(-90, z_axis) + square(true));
    p.push_back({"corner-kinds", "a corner under a distant light, a point light and a disk",
                 view("0 1.8 0  -0.3 0 0  0 0 1", "\"float fov\" 60", 3) + two_walls + sun + point +
                     group(paint(0) + at(-0.4, 0.75, 0.3) + scale(0.03) + square(false)) +
                     group(shining(4) + at(0.6, 0.9, 0) + turn(90, x_axis) +
                           "Shape \"disk\" \"float radius\" 0.3\n"),
                 9});
    // A pane lets through even light, which photons do not blur.
    std::string pane = group(at(0, 0.5, 0) + glass + scale(1.5) + square(true)) +
                       group(at(0, 0.45, 0) + glass + scale(1.5) + square(false));
    std::string under_pane = from_above(0.4, 3) + small_floor + pane;
    p.push_back({"pane-sky", "a floor under a pane of glass and a white sky", under_pane + sky()});
    p.push_back({"through-pane", "the same floor, seen through the pane",
                 from_above(1, 5) + small_floor + pane + sky()});
    std::string picture = group(
        turn(-90, x_axis) + "LightSource \"infinite\" \"string filename\" \"scenes/sky.pfm\"\n");
    p.push_back({"picture-lamps", "a floor under lamps, a point light and the picture of a sky",
                 from_above(0.5) + picture + small_floor +
                     lamp(at(-0.4, 0.8, 0) + scale(0.3), 300) +
                     lamp(at(0.4, 2.5, 0.2) + scale(0.3), 100) +
                     "LightSource \"point\" \"rgb I\" [40 40 40] \"point3 from\" [0 0.8 -0.3]\n",
                 17});
    p.push_back({"pane-picture", "a floor under a pane of glass and the picture of a sky",
                 under_pane + picture, 21, 21, 128});
    p.push_back({"pane-point", "a floor under a pane of glass, a point light and a distant one",
                 under_pane + sun + point, 20});
    p.push_back({"still-life", "a room with glass, a mirror and rough metal under three lamps",
                 view("0 0 -0.95  0 -0.2 0  0 1 0", "\"float fov\" 80", 4) +
                     group(cube(paint(0.5))) + lamp(at(0, 0.99, 0), 2) +
                     lamp(at(-0.98, 0.2, 0) + turn(90, z_axis) + scale(0.5), 4) +
                     lamp(at(0.6, 0.3, -0.2) + turn(40, z_axis) + scale(0.3), 3, true) +
                     group(at(-0.4, -0.65, 0.3) + glass + ball(0.35)) +
                     group(at(0.45, -0.7, 0.4) + metal(0.9) + ball(0.3)) +
                     group(at(0, -0.8, -0.1) + metal(0.9, smoother) + ball(0.2)),
                 13, 21, 256});
}

std::string quad(const std::string& corners) {
    return "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [" + corners +
           "]\n";
}
std::string quad_from(double x, double y, double z, double width, double height) {
    return quad(format("%g %g %g  %g %g %g  %g %g %g  %g %g %g", x, y, z, x, y + height, z,
                       x + width, y + height, z, x + width, y, z));
}
/// Lamps that fill the middle of some of the 4 x 4 tiles of a picture of a field of view of 90.
std::string pattern(int width) {
    struct Lamp {
        int x, y;
        double L;
    };
    std::string text = view("0 0 0  0 0 1  0 1 0", "\"float fov\" 90", 1, width);
    for (Lamp lamp : {Lamp{0, 0, 3}, {1, 0, 1}, {0, 2, 0.5}, {3, 3, 2}, {2, 1, 0.25}}) {
        double w = 2 * width / 16.0, x = w * (lamp.x - 2) + w / 4, y = 2.0 * (2 - lamp.y) - 0.5;
        text += group(shining(lamp.L) + paint(0) + quad_from(x, y - 1, 4, w / 2, 1));
    }
    return text;
}

/// What is for any renderer: quads and spheres, and one material each.
void add_for_any_renderer(std::vector<KnownScene>& p) {
    p.push_back({"frame", "lamps that the camera sees", pattern(16)});
    p.push_back({"wide", "lamps that the camera sees, in a wide picture", pattern(32)});
    p.push_back({"paint", "a coloured floor under a coloured lamp",
                 above + floor_of("Material \"diffuse\" \"rgb reflectance\" [.8 .4 .2] ") +
                     group("AreaLightSource \"diffuse\" \"rgb L\" [1 2 6] " + paint(0) +
                           quad("-.5 2 -.5  .5 2 -.5  .5 2 .5  -.5 2 .5"))});
    p.push_back({"ball", "a floor under a shining ball",
                 above + floor_here + group(shining(1) + paint(0) + at(0, 2, 0) + ball(0.5))});
    p.push_back({"reflection", "a lamp behind the camera, in a mirror",
                 view("0 0 0  0 0 1  0 1 0", "\"float fov\" 20") +
                     group(shining(1) + paint(0) + quad("-9 -9 -3  9 -9 -3  9 9 -3  -9 9 -3")) +
                     group(metal(0.9) + quad("-1 -1 2  -1 1 2  1 1 2  1 -1 2"))});
    std::string wall;
    for (int i = 0; i < 4; i++)
        wall += group(shining(2.0 / (1 << i)) + paint(0) +
                      quad_from(i % 2 ? 0 : -20, i < 2 ? 0 : -20, 3, 20, 20));
    p.push_back(
        {"lens", "a wall of four lamps, seen through a ball of glass",
         view("0 0 -4  .1 .1 0  0 1 0", "\"float fov\" 24", 8) + group(glass + ball(1)) + wall});
    p.push_back({"tilted", "a square that faces away from the camera, seen from above at an angle",
                 view("0 3 -3  0 0 0  0 1 0") +
                     group(paint(0.5) + quad("-1.2 0 -.6  1.2 0 -.6  1.2 0 .9  -1.2 0 .9")) +
                     group(shining(1) + paint(0) + quad("-2 4 -2  2 4 -2  2 4 2  -2 4 2"))});
    p.push_back({"pearl", "a grey ball in a ball of glass, under a sky",
                 view("0 0 -4  0 0 0  0 1 0", "\"float fov\" 16", 20) + sky() +
                     group(glass + ball(1)) + group(paint(0.5) + at(0.1, 0, -0.4) + ball(0.5))});
    for (int depth : {1, 2})
        p.push_back(
            {format("room-%d", depth), "a grey room with a lamp, with shorter paths", room(depth)});
    p.push_back({"sphere-2",
                 "the inside of a sphere that shines and reflects half, with shorter paths",
                 shining_sphere(paint(0.5), 2)});
}

std::vector<KnownScene> all_scenes() {
    std::vector<KnownScene> scenes;
    add_floors(scenes);
    add_second_vertices(scenes);
    add_skies(scenes);
    add_kinds_of_lights(scenes);
    add_bent(scenes);
    add_glass_and_metal(scenes);
    add_cameras(scenes);
    add_wavelengths_and_shares(scenes);
    add_combinations(scenes);
    add_for_any_renderer(scenes);
    return scenes;
}

/// Reads the light of each scene: its name, the source of the numbers, and these:
/// "all=MEAN~ERROR LDE=...".
void add_light(std::vector<KnownScene>& scenes, const std::string& file) {
    std::istringstream lines(read_file(file));
    for (std::string line; std::getline(lines, line);) {
        if (line[0] == '#') continue;
        std::istringstream cells(line);
        std::string name, source, number;
        std::getline(cells, name, '\t');
        std::getline(cells, source, '\t');
        auto scene = std::find_if(scenes.begin(), scenes.end(),
                                  [&](const KnownScene& s) { return s.name == name; });
        if (scene == scenes.end()) throw InputError(file + ": error: no scene " + name);
        scene->source = source;
        while (cells >> number) {
            size_t equal = number.find('='), error = number.find('~');
            scene->light[number.substr(0, equal)] = {std::stod(number.substr(equal + 1)),
                                                     std::stod(number.substr(error + 1))};
        }
    }
}

}  // namespace

const std::vector<KnownScene>& known_scenes() {
    static const std::vector<KnownScene> scenes = [] {
        std::vector<KnownScene> all = all_scenes();
        add_light(all, "tests/known/light.tsv");
        return all;
    }();
    return scenes;
}

const KnownScene& known_scene(const std::string& name) {
    for (const KnownScene& scene : known_scenes())
        if (scene.name == name) return scene;
    throw InputError("error: no known scene " + name);
}
