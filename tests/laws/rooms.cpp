// Rooms that are put together at random from what scenes may hold, and laws that hold in all of
// them.
#include "tests/laws/laws.h"
#include "tests/methods/table.h"

namespace {

/// Draws scene text: the same for the same seed.
class Draw {
public:
    explicit Draw(uint32_t seed) : random_(random_numbers(seed)) {}
    double number(double low, double high) { return low + (high - low) * double{random_.u1()}; }
    size_t index(size_t n) { return static_cast<size_t>(random_.u1() * static_cast<float>(n)); }
    bool coin() { return index(2) == 0; }

    /// Three numbers between brackets.
    std::string three(double low, double high) {
        std::string text = "[";
        for (int i = 0; i < 3; i++) text += std::to_string(number(low, high)) + " ";
        return text + "]";
    }
    std::string turn() {
        std::string axis = three(-1, 1);
        return "Rotate " + std::to_string(number(0, 360)) + " " + axis.substr(1, axis.size() - 2) +
               " ";
    }

private:
    Sampler random_;
};

std::string matt(Draw& draw) {
    return "Material \"diffuse\" \"rgb reflectance\" " + draw.three(0.2, 0.9) + "\n";
}
std::string any_material(Draw& draw) {
    switch (draw.index(4)) {
        case 0: return matt(draw);
        case 1:
            return "Material \"conductor\" \"rgb eta\" " + draw.three(0.2, 2) + " \"rgb k\" " +
                   draw.three(1, 4) + " \"float roughness\" " +
                   std::to_string(draw.number(0.3, 0.6)) + " \"bool remaproughness\" false\n";
        case 2: return "Material \"conductor\" \"rgb reflectance\" " + draw.three(0.5, 1) + "\n";
        default: return "Material \"dielectric\" \"float eta\" 1.5\n";
    }
}

/// A shape about as large as the unit ball: whole, flat, or, where `leaning`, with normals that
/// lean.
std::string any_shape(Draw& draw, bool leaning) {
    std::string turn = draw.turn();
    switch (draw.index(leaning ? 4 : 3)) {
        case 0: return "Shape \"sphere\" \"float radius\" 0.7\n";
        case 1: return turn + "Shape \"disk\" \"float radius\" 0.9\n";
        case 2: return turn + square(0, draw.coin());
        default:
            return turn +
                   "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3 0 3 1 1 3 2] "
                   "\"point3 P\" [.8 .8 .8  .8 -.8 -.8  -.8 .8 -.8  -.8 -.8 .8] "
                   "\"normal N\" [.8 .8 .8  .8 -.8 -.8  -.8 .8 -.8  -.8 -.8 .8]\n";
    }
}

std::string any_light(Draw& draw) {
    auto number = [&](double low, double high) { return std::to_string(draw.number(low, high)); };
    std::string place = "Translate " + number(-1.5, 1.5) + " " + number(0.8, 1.6) + " " +
                        number(-1.5, 1) + " Scale .7 .7 .7 ";
    std::string L = "\"rgb L\" " + draw.three(1, 3);
    switch (draw.index(5)) {
        case 0: return "LightSource \"infinite\" \"rgb L\" " + draw.three(0.2, 0.6) + "\n";
        case 1:
            return "LightSource \"point\" \"rgb I\" " + draw.three(2, 6) + " \"point3 from\" [" +
                   number(-2, 2) + " " + number(0, 2) + " -3]\n";
        case 2:
            return "LightSource \"distant\" \"rgb L\" " + draw.three(0.5, 1) +
                   " \"point3 from\" [" + number(-2, 2) + " 2 -3] \"point3 to\" [0 0 0]\n";
        default: {
            std::string both = draw.coin() ? " \"bool twosided\" true\n" : "\n";
            std::string side = draw.coin() ? "ReverseOrientation " : "";
            return "AttributeBegin " + matt(draw) + place + side + "AreaLightSource \"diffuse\" " +
                   L + both + any_shape(draw, true) + "AttributeEnd\n";
        }
    }
}

}  // namespace

std::string generated_room(uint32_t seed) {
    Draw draw(seed);
    auto placed = [&](const std::string& where, const std::string& what) {
        return "AttributeBegin " + where + what + "AttributeEnd\n";
    };
    std::string world = any_light(draw);
    if (draw.coin()) world += any_light(draw);
    std::string floor = matt(draw), wall = draw.coin() ? any_material(draw) : matt(draw);
    world += placed(floor, "Translate 0 -1 0 Scale 3 1 3 " + square(0, true));
    world += placed(wall, "Translate 0 0 2 Rotate -90 1 0 0 Scale 3 1 3 " + square(0, true));
    for (double x : {-0.9, 0.9}) {
        std::string where = "Translate " + std::to_string(x) + " " +
                            std::to_string(draw.number(-0.6, 0.2)) + " 0 Scale .8 .8 .8 ";
        std::string material = any_material(draw);
        // Mirrors and glass with normals that lean too far let paths through in one direction
        // alone.
        bool leaning = material.find("diffuse") != std::string::npos ||
                       material.find("roughness") != std::string::npos;
        world += placed(material + where, any_shape(draw, leaning));
    }
    return world;
}
