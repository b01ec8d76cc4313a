// A drawing in the SVG format, element by element.
#pragma once
#include <cstdio>
#include <string>

#include "common/base/vec.h"

class Svg {
public:
    void line(Vec2 a, Vec2 b, const char* style) {
        add("<line x1='%.1f' y1='%.1f' x2='%.1f' y2='%.1f' %s/>\n", double{a.x}, double{a.y},
            double{b.x}, double{b.y}, style);
    }
    void circle(Vec2 c, float r, const char* style) {
        add("<circle cx='%.1f' cy='%.1f' r='%.1f' %s/>\n", double{c.x}, double{c.y}, double{r},
            style);
    }
    void rectangle(Vec2 corner, Vec2 size, const char* style) {
        add("<rect x='%.1f' y='%.1f' width='%.1f' height='%.1f' %s/>\n", double{corner.x},
            double{corner.y}, double{size.x}, double{size.y}, style);
    }
    /// Text with a contrasting outline; `at`: left end of its base line.
    void text(Vec2 at, const std::string& words) {
        add("<text x='%.1f' y='%.1f' font-family='sans-serif' font-size='13' stroke='white' "
            "stroke-width='3' paint-order='stroke'>%s</text>\n",
            double{at.x}, double{at.y}, words.c_str());
    }
    /// A picture, as the text of a .png in base 64.
    void picture(Vec2 corner, Vec2 size, const std::string& png) {
        add("<image x='%.1f' y='%.1f' width='%.1f' height='%.1f' opacity='0.6' ", double{corner.x},
            double{corner.y}, double{size.x}, double{size.y});
        body_ += "href='data:image/png;base64," + png + "'/>\n";
    }
    /// Clips what follows to a rectangle, until end_clip().
    void begin_clip(Vec2 corner, Vec2 size) {
        clips_++;
        add("<clipPath id='clip%d'>", clips_);
        rectangle(corner, size, "");
        add("</clipPath><g clip-path='url(#clip%d)'>\n", clips_);
    }
    void end_clip() { body_ += "</g>\n"; }

    std::string finish(Vec2 size) const {
        char head[200];
        std::snprintf(head, sizeof head,
                      "<svg xmlns='http://www.w3.org/2000/svg' width='%.0f' height='%.0f'>\n"
                      "<rect width='100%%' height='100%%' fill='white'/>\n",
                      double{size.x}, double{size.y});
        return head + body_ + "</svg>\n";
    }

private:
    template <typename... Args>
    void add(const char* pattern, Args... args) {
        char text[400];
        std::snprintf(text, sizeof text, pattern, args...);
        body_ += text;
    }
    std::string body_;
    int clips_ = 0;
};
