// SPDX-License-Identifier: Apache-2.0
#include "aglow/scene/gltf/edit/add_nodes.h"

namespace aglow::gltf::edit {

void add_nodes(Document& document, const Scene& scene) {
    for (size_t n = list_of(document.json, "nodes").size(); n < scene.nodes.size(); ++n) {
        const Node& node = scene.nodes[n];
        Json json = {{"mesh", node.mesh}, {"matrix", node.matrix.m}};
        if (!node.name.empty()) json["name"] = node.name;
        document.json["nodes"].push_back(std::move(json));
        Json& parent = document.json["nodes"][static_cast<size_t>(node.parent)];
        parent.erase("mesh");
        array_of(parent, "children").push_back(n);
    }
}

}  // namespace aglow::gltf::edit
