// Words beside points of a drawing.
#pragma once
#include <vector>

#include "common/explaining/svg.h"

/// Finds positions for short words beside points, so that words cover neither words nor points.
class Labels {
public:
    void keep_free(Vec2 point) { taken_.push_back({{point.x - 4, point.y - 4}, {8, 8}}); }

    void put(Svg& svg, Vec2 point, const std::string& words) {
        Vec2 size = {8.0f * static_cast<float>(words.size()), 13};
        for (int i = 0; i < 96; i++) {  // in circles of growing radius
            float angle = 2 * pi * (static_cast<float>(i % 16) / 16 - 0.125f);
            float away = 14 + 10 * static_cast<float>(i / 16);
            Vec2 middle = {point.x + away * std::cos(angle), point.y + away * std::sin(angle)};
            Box2 box = {{middle.x - size.x / 2, middle.y - size.y / 2}, size};
            if (i < 95 && is_taken(box)) continue;
            taken_.push_back(box);
            if (i >= 16) svg.line(point, middle, "stroke='#999' stroke-width='0.7'");
            svg.text({box.corner.x, box.corner.y + 11}, words);
            return;
        }
    }

private:
    struct Box2 {
        Vec2 corner, size;
    };
    bool is_taken(const Box2& a) const {
        for (const Box2& b : taken_) {
            bool apart = a.corner.x > b.corner.x + b.size.x || b.corner.x > a.corner.x + a.size.x ||
                         a.corner.y > b.corner.y + b.size.y || b.corner.y > a.corner.y + a.size.y;
            if (!apart) return true;
        }
        return false;
    }
    std::vector<Box2> taken_;
};
