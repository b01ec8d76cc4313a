#include <cmath>

#include "common/base/hash.h"
#include "tests/known/scenes.h"
#include "tests/known/words.h"

namespace {

/// Random numbers, from a hash of their index. No expression below draws two of them: compilers
/// differ in the order in which they evaluate a sum or arguments, and would make other worlds.
class Dice {
public:
    explicit Dice(uint32_t seed) : seed_(seed) {}
    double from(double low, double high) { return low + (high - low) * next() * 0x1p-32; }
    /// Evenly in the logarithm.
    double power(double low, double high) { return low * std::pow(high / low, from(0, 1)); }
    int below(int n) { return static_cast<int>(from(0, n)); }
    bool chance(double p) { return from(0, 1) < p; }
    std::string rgb(double low, double high) {
        double r = from(low, high), g = from(low, high), b = from(low, high);
        return chance(0.3) ? format("[%.3g %.3g %.3g]", r, r, r)
                           : format("[%.3g %.3g %.3g]", r, g, b);
    }

private:
    uint32_t next() { return hash32(seed_, count_++); }
    uint32_t seed_, count_ = 0;
};

struct World {
    Dice& dice;
    const int chapter;
    const double bright = dice.chance(0.5) ? dice.power(1e-3, 1e3) : 1;
    bool has_picture = false;
    const double size = dice.chance(0.3) ? dice.power(0.01, 100) : 1;  // of all

    bool moves() { return chapter >= 16 && chapter <= 22 && dice.chance(0.3); }

    std::string diffuse(double least = 0) {
        return "Material \"diffuse\" \"rgb reflectance\" " + dice.rgb(least, 0.9) + "\n";
    }
    /// A checkered ball or disk.
    std::string checkered(int number) {
        std::string shape = dice.chance(0.5) ? ball(1) : "Shape \"disk\"\n";
        std::string shrunk = scale(dice.power(0.1, 1)), where = place(0.1, 1.5);
        std::string color2 = dice.rgb(0, 0.9), color1 = dice.rgb(0, 0.9);
        return format("Texture \"%d\" \"spectrum\" \"checkerboard\" ", number) +
               "\"float uscale\" 6 \"float vscale\" 4 \"rgb tex1\" " + color1 + " \"rgb tex2\" " +
               color2 + format(" Material \"diffuse\" \"texture reflectance\" \"%d\" ", number) +
               where + shrunk + shape;
    }
    std::string roughness() {
        if (chapter < 13 || dice.chance(0.3)) return "";
        return format(" \"float roughness\" %.3g \"bool remaproughness\" false",
                      dice.power(0.001, 0.9));
    }
    std::string material() {
        int kind = dice.below(8);
        std::string rough = kind < 2 ? roughness() : "";
        std::string k = kind == 1 ? dice.rgb(1, 3) : "";
        switch (kind) {
            case 0:
                return "Material \"conductor\" \"rgb reflectance\" " + dice.rgb(0.5, 1) + rough +
                       "\n";
            case 1:
                return "Material \"conductor\" \"rgb eta\" " + dice.rgb(0.5, 2) + " \"rgb k\" " +
                       k + rough + "\n";
            case 2:
                return format("Material \"dielectric\" \"float eta\" %.3g\n", dice.from(1.2, 2));
            case 3:
                if (chapter != 18 && chapter != 19) return diffuse();
                return std::string("Material \"dielectric\" \"spectrum eta\" ") +
                       (dice.chance(0.5) ? "\"glass-F11\"\n" : "\"glass-BK7\"\n");
            default: return diffuse();
        }
    }
    std::string shape() {
        switch (dice.below(6)) {
            case 0: return square(true);
            case 1: return square(false, leaning(dice.from(5, 50), false));
            case 2: return "Shape \"disk\"\n";
            case 3: return square(true) + group(at(0, -dice.from(0.02, 1), 0) + square(false));
            default: return ball(1);
        }
    }
    std::string place(double near, double far) {
        double z = dice.from(0.1, 1), y = dice.from(-1, 1), x = dice.from(-1, 1);
        double angle = dice.from(0, 360), up = dice.power(near, far), out = dice.power(near, far);
        return turn(dice.from(0, 360), "0 1 0") + at(out, up, 0) +
               format("Rotate %.4g %.3g %.3g %.3g ", angle, x, y, z);
    }
    std::string motion() {
        if (chapter < 16 || chapter > 22 || dice.chance(0.6)) return "";
        double angle = dice.from(0, 60), y = dice.from(-0.3, 0.3), x = dice.from(-0.5, 0.5);
        return "ActiveTransform EndTime " + at(x, y, 0) + turn(angle, z_axis) +
               "ActiveTransform All ";
    }
    std::string light() {
        std::string color = dice.rgb(0.2, 1);
        std::string power = format(" \"float scale\" %.3g", bright * dice.power(0.3, 30));
        int kind = dice.below(chapter < 9 ? 9 : 12);
        if (chapter >= 17 && kind < 3) kind = 0;  // skies, which may have pictures
        switch (kind) {
            case 0:
                if (chapter < 17 || has_picture || dice.chance(0.3))
                    return "LightSource \"infinite\" \"rgb L\" " + color + power + "\n";
                has_picture = true;
                return group("Rotate -90 1 0 0 " + turn(dice.from(0, 360), z_axis) +
                             "LightSource \"infinite\" \"string filename\" \"scenes/sky.pfm\"" +
                             power + "\n");
            case 9:
            case 10:
                return group(place(0.3, 3) + "LightSource \"point\" \"rgb I\" " + color + power +
                             "\n");
            case 11:
                double z = dice.from(-1, 1), y = dice.from(0.2, 1), x = dice.from(-1, 1);
                return "LightSource \"distant\" \"rgb L\" " + color + power +
                       format(" \"point3 from\" [%.3g %.3g %.3g] \"point3 to\" [0 0 0]\n", x, y, z);
        }
        std::string where = dice.chance(0.2) ? place(1, 100) : place(0.1, 3);
        std::string painted = paint(dice.chance(0.5) ? 0 : 0.4);
        std::string shines = "AreaLightSource \"diffuse\" \"rgb L\" " + color + power +
                             " \"bool twosided\" " + (dice.chance(0.3) ? "true " : "false ") +
                             painted;
        double side = dice.power(0.02, 0.8);
        std::string text = group(shines + where + scale(side) + shape());
        if (dice.chance(0.2))  // a lamp as long as it may be
            text = group(shines + where + format("Scale %.3g 1 %.3g ", side, 0.1 * side) +
                         square(false));
        if (dice.chance(0.2))  // a board close to it
            text += group(paint(0) + where + at(side, -dice.power(0.001, 1), 0) + scale(side) +
                          square(true));
        return text;
    }
    std::string camera() {
        int width = 8 + 4 * dice.below(4), height = 8 + 4 * dice.below(3);
        std::string text = format(
            "Film \"rgb\" \"integer xresolution\" %d \"integer yresolution\" %d\n"
            "PixelFilter \"box\" Integrator \"path\" \"integer maxdepth\" %d\n",
            width, height, dice.chance(0.2) ? 20 : 1 + dice.below(7));
        double distance = dice.chance(0.1) ? dice.power(5, 500) : dice.power(0.6, 5),
               angle = dice.from(0, 6.283),
               up = dice.chance(0.3) ? -0.5 : dice.from(0.1, 0.9);  // or from below the floor
        if (dice.chance(0.2)) text += scale(dice.power(0.3, 3)) + "\n";
        double z = dice.from(-0.3, 0.3), y = dice.from(0, 0.5), x = dice.from(-0.3, 0.3);
        text += format("LookAt %.4g %.4g %.4g  %.3g %.3g %.3g  0 1 0\n",
                       size * distance * std::cos(angle), size * distance * up,
                       size * distance * std::sin(angle), size * x, size * y, size * z);
        text += format("Camera \"perspective\" \"float fov\" %.3g",
                       distance > 5 ? 200 / distance : dice.power(10, 90));
        if (chapter >= 16 && chapter != 20 && dice.chance(0.3))
            text += format(" \"float lensradius\" %.3g \"float focaldistance\" %.3g",
                           size * dice.power(0.01, 0.2), size * distance);
        if (chapter >= 16 && chapter <= 22 && dice.chance(0.5)) {
            double close = dice.from(0.5, 1), open = dice.from(0, 0.4);
            text += format(" \"float shutteropen\" %.3g \"float shutterclose\" %.3g", open, close);
        }
        return text + "\nWorldBegin\n" + scale(size) + "\n";
    }
};

}  // namespace

std::string random_world(int chapter, uint32_t number) {
    Dice dice(number);
    World world{dice, chapter};
    std::string text = world.camera();
    std::string floor = scale(dice.power(1, 100)) + square(true);
    text += group(world.diffuse() + floor);
    if (dice.chance(0.3)) {  // in a room
        std::string walls = dice.chance(0.5) ? world.diffuse(0.7) : world.material();
        text += group(walls + at(0, 2, 0) + scale(dice.chance(0.5) ? 3 : 6) + "Shape \"sphere\"\n");
    }
    for (int n = 1 + dice.below(4); n > 0; n--) {
        std::string shape = world.shape(), size = scale(dice.power(0.05, 0.7));
        std::string motion = world.motion(), where = world.place(0.1, 1.5);
        text += group(world.material() + where + motion + size + shape);
    }
    for (int n = dice.below(3); n > 0; n--) text += group(world.checkered(n));
    int lights = dice.chance(0.1) ? 70 : 1 + dice.below(4);
    for (int n = lights; n > 0; n--) text += world.light();
    return text;
}
