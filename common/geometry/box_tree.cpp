#include "common/geometry/box_tree.h"

#include <numeric>

namespace {

bool are_near(const Box& a, const Box& b, float gap) {
    return max_component(max(a.low - b.high, b.low - a.high)) <= gap;
}

}  // namespace

BoxTree::BoxTree(const std::vector<Box>& boxes) : boxes_(boxes), order_(boxes.size()) {
    std::iota(order_.begin(), order_.end(), 0u);
    if (!boxes.empty()) build(0, static_cast<uint32_t>(boxes.size()));
}

void BoxTree::build(uint32_t first, uint32_t last) {
    size_t number = nodes_.size();
    Box box, middles;
    for (uint32_t k = first; k < last; k++) {
        const Box& b = boxes_[order_[k]];
        box.add(b);
        middles.add(b.centre());
    }
    nodes_.push_back({box, first, last, 0});
    if (last - first <= in_leaf) return;

    // Part them by their middles along the axis on which these differ most.
    Vec3 size = middles.high - middles.low;
    int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    uint32_t half = (first + last) / 2;
    std::nth_element(order_.begin() + first, order_.begin() + half, order_.begin() + last,
                     [&](uint32_t i, uint32_t j) {
                         return boxes_[i].centre()[axis] < boxes_[j].centre()[axis];
                     });
    build(first, half);
    nodes_[number].right = static_cast<uint32_t>(nodes_.size());
    build(half, last);
}

std::vector<uint32_t> BoxTree::near(const Box& box, float gap, size_t* looked_at) const {
    std::vector<uint32_t> found, next;
    size_t looked = 0;
    if (!nodes_.empty()) next.push_back(0);
    while (!next.empty()) {
        uint32_t number = next.back();
        const Node& node = nodes_[number];
        next.pop_back(), looked++;
        if (!are_near(node.box, box, gap)) continue;
        if (node.right != 0) {
            next.push_back(node.right), next.push_back(number + 1);
            continue;
        }
        for (uint32_t k = node.first; k < node.last; k++, looked++)
            if (are_near(boxes_[order_[k]], box, gap)) found.push_back(order_[k]);
    }
    std::sort(found.begin(), found.end());
    if (looked_at) *looked_at += looked;
    return found;
}
