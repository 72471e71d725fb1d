#pragma once

#include <string>

#include "solver/scene/scene.h"

// Small scenes that several tests of the room start from.

namespace afterglow {

/// A box from −1 to 1 around the origin, faces inwards, its top an emitter of material 1, and a camera.
inline Scene room_scene() {
    Scene scene;
    scene.name = "room";
    scene.materials.resize(2);
    scene.materials[0].name = "wall";
    scene.materials[0].reflectance = Rgb(0.5F);
    scene.materials[1].name = "lamp";
    scene.materials[1].reflectance = Rgb(0);
    scene.materials[1].emission = Rgb(3);
    Mesh mesh;
    mesh.name = "box";
    for (int corner = 0; corner < 8; ++corner)
        mesh.positions.emplace_back((corner & 1) != 0 ? 1 : -1, (corner & 2) != 0 ? 1 : -1,
                                    (corner & 4) != 0 ? 1 : -1);
    const auto quad = [&](Index a, Index b, Index c, Index d, Index material) {
        mesh.triangles.push_back({{a, b, c}, material});
        mesh.triangles.push_back({{a, c, d}, material});
    };
    quad(2, 3, 7, 6, 1);  // y = 1, seen from below
    quad(0, 4, 5, 1, 0);
    quad(0, 2, 6, 4, 0);
    quad(1, 5, 7, 3, 0);
    quad(0, 1, 3, 2, 0);
    quad(4, 6, 7, 5, 0);
    scene.meshes.push_back(mesh);
    scene.cameras.push_back({"camera", 0.7F});
    Node room;
    room.name = "room";
    room.mesh = 0;
    Node camera;
    camera.name = "camera";
    camera.camera = 0;
    scene.nodes = {room, camera};
    return scene;
}

/// The same without its far wall (z = −1).
inline Scene open_scene() {
    Scene scene = room_scene();
    auto& triangles = scene.meshes[0].triangles;
    triangles.erase(triangles.begin() + 8, triangles.begin() + 10);
    return scene;
}

}  // namespace afterglow
