#include "bound_joints.h"

namespace bendy::converter {

std::vector<bool> find_bound_joints(const Scene& scene) {
    std::vector<bool> bound(scene.joints.size());
    bool has_any = false;
    for (const Mesh& mesh : scene.meshes) {
        for (const std::uint32_t joint : mesh.palette.joints) bound[joint] = has_any = true;
    }
    if (!has_any) {
        bound.assign(bound.size(), true);
        return bound;
    }
    for (std::size_t joint = bound.size(); joint-- > 0;) {
        const std::uint32_t parent = scene.joints[joint].parent;
        if (bound[joint] && parent != kNone) bound[parent] = true;
    }
    return bound;
}

std::vector<std::vector<std::uint32_t>> list_children(const Scene& scene, const std::vector<bool>& chosen) {
    std::vector<std::vector<std::uint32_t>> children(scene.joints.size());
    for (std::uint32_t joint = 0; joint < scene.joints.size(); ++joint) {
        const std::uint32_t parent = scene.joints[joint].parent;
        if (chosen[joint] && parent != kNone) children[parent].push_back(joint);
    }
    return children;
}

}  // namespace bendy::converter
