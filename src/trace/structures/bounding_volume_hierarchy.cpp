#include "trace/structures/bounding_volume_hierarchy.hpp"

#include "core/threads/parallel_list.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <iterator>
#include <limits>
#include <stdexcept>
#include <utility>

namespace vkfv::trace {

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr int bin_count = 16;

struct Bounds {
    glm::vec3 lower = glm::vec3(infinity);
    glm::vec3 upper = glm::vec3(-infinity);

    void add(const glm::vec3& point) {
        lower = glm::min(lower, point);
        upper = glm::max(upper, point);
    }
    void add(const Bounds& other) {
        lower = glm::min(lower, other.lower);
        upper = glm::max(upper, other.upper);
    }
    // Half the surface area; 0 for an empty box.
    float area() const {
        const glm::vec3 size = glm::max(upper - lower, glm::vec3(0));
        return size.x * size.y + size.y * size.z + size.z * size.x;
    }
};

// A box in the order that the builder changes: with its index, so that the builder reads one place in memory.
struct Reference {
    Bounds box;
    std::uint32_t index;

    glm::vec3 centre() const { return 0.5F * box.lower + 0.5F * box.upper; }
};

// A node of the binary tree from which the wide one is made.
struct BinaryNode {
    Bounds box;
    std::uint32_t first = 0; // child, whose sibling follows; for a leaf: first reference
    std::uint32_t count = 0; // number of a leaf's references; 0: an inner node
};

struct Range {
    std::uint32_t node;
    std::uint32_t begin;
    std::uint32_t end;
    int depth;
};

// Partitions the references at the cheapest border between bins along the longest axis; returns where the upper part
// begins. begin or end: no border was found.
std::uint32_t part_by_area(std::vector<Reference>& references, const Range& range, const Bounds& centres) {
    struct Bin {
        Bounds box;
        std::uint32_t count = 0;
    };
    const glm::vec3 extent = centres.upper - centres.lower;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
    const float scale = bin_count / extent[axis];
    if (!std::isfinite(scale)) {
        return range.begin;
    }
    const auto bin_of = [&](const Reference& reference) {
        return std::min(static_cast<int>((reference.centre()[axis] - centres.lower[axis]) * scale), bin_count - 1);
    };
    std::array<Bin, bin_count> bins;
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
        Bin& bin = bins[static_cast<std::size_t>(bin_of(references[i]))];
        bin.box.add(references[i].box);
        ++bin.count;
    }
    std::array<float, bin_count> cost_above{}; // cost of all bins from this one on
    Bounds box;
    std::uint32_t count = 0;
    for (std::size_t bin = bin_count; bin-- > 1;) {
        box.add(bins[bin].box);
        count += bins[bin].count;
        cost_above[bin] = count == 0 ? 0 : box.area() * static_cast<float>(count);
    }
    box = {};
    count = 0;
    float least = infinity;
    int border = 0;
    for (std::size_t bin = 0; bin + 1 < bin_count; ++bin) {
        box.add(bins[bin].box);
        count += bins[bin].count;
        const float cost = (count == 0 ? 0 : box.area() * static_cast<float>(count)) + cost_above[bin + 1];
        if (count > 0 && count < range.end - range.begin && cost < least) {
            least = cost;
            border = static_cast<int>(bin) + 1;
        }
    }
    const auto middle = std::partition(references.begin() + range.begin, references.begin() + range.end,
                                       [&](const Reference& reference) { return bin_of(reference) < border; });
    return static_cast<std::uint32_t>(middle - references.begin());
}

std::uint32_t part_by_median(std::vector<Reference>& references, const Range& range, const Bounds& centres) {
    const glm::vec3 extent = centres.upper - centres.lower;
    const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
    const std::uint32_t middle = range.begin + (range.end - range.begin) / 2;
    std::nth_element(references.begin() + range.begin, references.begin() + middle, references.begin() + range.end,
                     [axis](const Reference& a, const Reference& b) {
                         return std::pair(a.centre()[axis], a.index) < std::pair(b.centre()[axis], b.index);
                     });
    return middle;
}

// Makes the node of a range and returns the middle: for a leaf its end, else the border between its two children.
std::uint32_t split(std::vector<BinaryNode>& nodes, std::vector<Reference>& references, const Range& range,
                    std::size_t leaf_size) {
    const std::uint32_t count = range.end - range.begin;
    Bounds box;
    Bounds centres;
    for (std::uint32_t i = range.begin; i < range.end; ++i) {
        box.add(references[i].box);
        centres.add(references[i].centre());
    }
    if (count <= leaf_size) {
        nodes[range.node] = {box, range.begin, count};
        return range.end;
    }
    // Splits by medians need this many levels; the heuristic may use the levels beyond.
    const int halvings = std::bit_width(count - 1);
    std::uint32_t middle = range.begin;
    if (range.depth + halvings < hierarchy_depth) {
        middle = part_by_area(references, range, centres);
    }
    if (middle == range.begin || middle == range.end) {
        middle = part_by_median(references, range, centres);
    }
    nodes[range.node] = {box, static_cast<std::uint32_t>(nodes.size()), 0};
    nodes.resize(nodes.size() + 2);
    return middle;
}

// Builds the nodes of a range; the first is its root. Ranges of at most `whole` references are left to `parts`.
std::vector<BinaryNode> build_nodes(std::vector<Reference>& references, Range range, std::size_t leaf_size,
                                    std::uint32_t whole, std::vector<Range>& parts) {
    std::vector<BinaryNode> nodes(1);
    range.node = 0;
    std::vector<Range> pending = {range};
    while (!pending.empty()) {
        const Range next = pending.back();
        pending.pop_back();
        if (next.end - next.begin <= whole) {
            parts.push_back(next);
            continue;
        }
        const std::uint32_t middle = split(nodes, references, next, leaf_size);
        if (middle < next.end) {
            const std::uint32_t first = nodes[next.node].first;
            pending.push_back({first + 1, middle, next.end, next.depth + 1});
            pending.push_back({first, next.begin, middle, next.depth + 1});
        }
    }
    return nodes;
}

// The number of references that a thread takes as a whole. It does not depend on the number of cores, so that every
// machine makes the same tree.
constexpr std::uint32_t references_a_part = 1U << 15;

std::vector<BinaryNode> build_binary(std::vector<Reference>& references, std::size_t leaf_size) {
    std::vector<Range> parts;
    std::vector<BinaryNode> nodes = build_nodes(references, {0, 0, static_cast<std::uint32_t>(references.size()), 1},
                                                leaf_size, references_a_part, parts);
    const auto below = parallel_list(static_cast<int>(parts.size()), [&](int part) {
        std::vector<Range> none;
        return build_nodes(references, parts[static_cast<std::size_t>(part)], leaf_size, 0, none);
    });
    for (std::size_t part = 0; part < parts.size(); ++part) {
        // The part's first node has a place already, the others are appended.
        const auto base = static_cast<std::uint32_t>(nodes.size()) - 1;
        const auto placed = [base](BinaryNode node) {
            node.first += node.count == 0 ? base : 0;
            return node;
        };
        nodes[parts[part].node] = placed(below[part].front());
        std::transform(below[part].begin() + 1, below[part].end(), std::back_inserter(nodes), placed);
    }
    return nodes;
}

// Up to eight descendants of a binary node: the largest inner one is opened as long as there is room.
std::vector<std::uint32_t> open(const std::vector<BinaryNode>& nodes, std::uint32_t root) {
    std::vector<std::uint32_t> children = {root};
    while (children.size() < 8) {
        float largest = -1;
        std::size_t chosen = 0;
        for (std::size_t k = 0; k < children.size(); ++k) {
            const BinaryNode& node = nodes[children[k]];
            if (node.count == 0 && node.box.area() > largest) {
                largest = node.box.area();
                chosen = k;
            }
        }
        if (largest < 0) {
            break;
        }
        const std::uint32_t first = nodes[children[chosen]].first;
        children[chosen] = first;
        children.push_back(first + 1);
    }
    return children;
}

constexpr std::uint32_t no_child = std::numeric_limits<std::uint32_t>::max();

// Assigns children to slots: the pair of child and free slot that suit each other best comes first, and so on.
std::array<std::uint32_t, 8> in_slots(const std::vector<BinaryNode>& nodes, std::vector<std::uint32_t> children,
                                      const Bounds& box) {
    std::array<std::uint32_t, 8> slots;
    slots.fill(no_child);
    std::array<std::array<float, 8>, 8> suits{};
    for (std::size_t k = 0; k < children.size(); ++k) {
        const Bounds& child = nodes[children[k]].box;
        const glm::vec3 offset = (child.lower - box.lower) + (child.upper - box.upper);
        for (std::size_t slot = 0; slot < 8; ++slot) {
            suits[k][slot] = ((slot & 1) != 0 ? offset.x : -offset.x) + ((slot & 2) != 0 ? offset.y : -offset.y) +
                             ((slot & 4) != 0 ? offset.z : -offset.z);
        }
    }
    for (std::size_t placed = 0; placed < children.size(); ++placed) {
        std::size_t child = 0;
        std::size_t place = 0;
        float best = -infinity;
        for (std::size_t k = 0; k < children.size(); ++k) {
            for (std::size_t slot = 0; slot < 8; ++slot) {
                if (children[k] != no_child && slots[slot] == no_child && suits[k][slot] > best) {
                    best = suits[k][slot];
                    child = k;
                    place = slot;
                }
            }
        }
        slots[place] = std::exchange(children[child], no_child);
    }
    return slots;
}

// The node's frame of quantised coordinates, with no step finer than the smallest normal float.
HierarchyNode frame_of(const Bounds& box) {
    HierarchyNode node{};
    node.origin = box.lower;
    for (int axis = 0; axis < 3; ++axis) {
        int exponent = 0;
        std::frexp((static_cast<double>(box.upper[axis]) - static_cast<double>(box.lower[axis])) / 255.0, &exponent);
        node.exponents[axis] = static_cast<std::uint8_t>(std::clamp(exponent + 127, 1, 254));
    }
    return node;
}

void set_box(HierarchyNode& node, std::size_t slot, const Bounds& box) {
    for (int axis = 0; axis < 3; ++axis) {
        const double step = std::ldexp(1.0, node.exponents[axis] - 127);
        const double lower = (static_cast<double>(box.lower[axis]) - static_cast<double>(node.origin[axis])) / step;
        const double upper = (static_cast<double>(box.upper[axis]) - static_cast<double>(node.origin[axis])) / step;
        node.lower[axis][slot] = static_cast<std::uint8_t>(std::floor(lower));
        node.upper[axis][slot] = static_cast<std::uint8_t>(std::ceil(upper));
    }
}

// A wide node that is to be made of a binary one.
struct Widening {
    std::uint32_t node;
    std::uint32_t source;
};

// Makes the wide node, and reserves places for the nodes in its slots, which are to be made next.
void widen(const std::vector<BinaryNode>& binary, const std::vector<Reference>& references, const Widening& widening,
           BoundingVolumeHierarchy& result, std::vector<Widening>& pending) {
    const Bounds& box = binary[widening.source].box;
    HierarchyNode node = frame_of(box);
    node.first_node = static_cast<std::uint32_t>(result.nodes.size());
    node.first_primitive = static_cast<std::uint32_t>(result.order.size());
    const auto slots = in_slots(binary, open(binary, widening.source), box);
    for (std::size_t slot = 0; slot < 8; ++slot) {
        if (slots[slot] == no_child) {
            continue;
        }
        const BinaryNode& child = binary[slots[slot]];
        set_box(node, slot, child.box);
        if (child.count == 0) {
            node.inner = static_cast<std::uint8_t>(node.inner | 1U << slot);
            node.slots[slot] = static_cast<std::uint8_t>(32 + 24 + slot);
            pending.push_back({static_cast<std::uint32_t>(result.nodes.size()), slots[slot]});
            result.nodes.emplace_back();
        } else {
            const std::size_t offset = result.order.size() - node.first_primitive;
            node.slots[slot] = static_cast<std::uint8_t>(((1U << child.count) - 1) << 5 | offset);
            for (std::uint32_t k = 0; k < child.count; ++k) {
                result.order.push_back(references[child.first + k].index);
            }
        }
    }
    result.nodes[widening.node] = node;
}

// Widens the binary tree below `source`; node 0 is the root.
BoundingVolumeHierarchy widen_all(const std::vector<BinaryNode>& binary, const std::vector<Reference>& references,
                                  std::uint32_t source) {
    BoundingVolumeHierarchy result;
    result.nodes.emplace_back();
    std::vector<Widening> pending = {{0, source}};
    while (!pending.empty()) {
        const Widening next = pending.back();
        pending.pop_back();
        widen(binary, references, next, result, pending);
    }
    return result;
}

// Puts a tree where a place is reserved for its root.
void graft(BoundingVolumeHierarchy& result, std::uint32_t place, const BoundingVolumeHierarchy& part) {
    const auto base = static_cast<std::uint32_t>(result.nodes.size()) - 1;
    const auto first_primitive = static_cast<std::uint32_t>(result.order.size());
    const auto placed = [&](HierarchyNode node) {
        node.first_node += base;
        node.first_primitive += first_primitive;
        return node;
    };
    result.nodes[place] = placed(part.nodes.front());
    std::transform(part.nodes.begin() + 1, part.nodes.end(), std::back_inserter(result.nodes), placed);
    result.order.insert(result.order.end(), part.order.begin(), part.order.end());
}

// The number of subtrees below the uppermost nodes that are made in parallel.
constexpr std::size_t grafts = 512;

} // namespace

BoundingVolumeHierarchy build_hierarchy(std::span<const vulkan::Box> boxes, std::size_t leaf_size) {
    if (boxes.empty() || boxes.size() > std::numeric_limits<std::uint32_t>::max() / 2 || leaf_size < 1 ||
        leaf_size > hierarchy_leaf_size) {
        throw std::logic_error("a hierarchy takes 1 to 2^31 - 1 boxes and leaves of 1 to 3");
    }
    std::vector<Reference> references;
    references.reserve(boxes.size());
    for (const vulkan::Box& box : boxes) {
        for (int axis = 0; axis < 3; ++axis) {
            if (!std::isfinite(box.minimum[axis]) || !std::isfinite(box.maximum[axis]) ||
                box.minimum[axis] > box.maximum[axis]) {
                throw std::logic_error("a box of a hierarchy has corners that are not finite or not in order");
            }
        }
        references.push_back({{box.minimum, box.maximum}, static_cast<std::uint32_t>(references.size())});
    }
    const std::vector<BinaryNode> binary = build_binary(references, leaf_size);

    BoundingVolumeHierarchy result;
    result.nodes.reserve(boxes.size() / 4 + 1);
    result.order.reserve(boxes.size());
    result.nodes.emplace_back();
    std::vector<Widening> pending = {{0, 0}};
    std::size_t made = 0;
    for (; made < pending.size() && pending.size() - made < grafts; ++made) {
        const Widening next = pending[made];
        widen(binary, references, next, result, pending);
    }
    const auto parts = parallel_list(static_cast<int>(pending.size() - made), [&](int part) {
        return widen_all(binary, references, pending[made + static_cast<std::size_t>(part)].source);
    });
    for (std::size_t part = 0; part < parts.size(); ++part) {
        graft(result, pending[made + part].node, parts[part]);
    }
    return result;
}

} // namespace vkfv::trace
