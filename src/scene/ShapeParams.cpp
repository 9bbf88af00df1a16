// What a person may change about the shapes of objects, and about the waves that run through them.
#include "scene/Keys.h"
#include "scene/Scene.h"

namespace lucent::scene {

const ParamTable& heightFieldParams() {
    static const Param params[] = {
        declare(&HeightField::heightScale, {.id = "heightScale",
                                            .label = "Height",
                                            .unit = "m",
                                            .min = 0,
                                            .max = 1e5,
                                            .high = 0.5,
                                            .group = Group::HeightField,
                                            .doc = "How high a height of 1 stands.",
                                            .attribute = "height-scale"}),
        declare(&HeightField::width, {.id = "width",
                                      .label = "Width",
                                      .unit = "m",
                                      .min = kAboveZero,
                                      .max = kLargest,
                                      .low = 0.1,
                                      .high = 10,
                                      .logarithmic = true,
                                      .doc = "Width of the field; its texels are square.",
                                      .attribute = "field-width"}),
    };
    static const ParamTable table = tableOf<HeightField>("shape", params);
    return table;
}

const ParamTable& heightSourceParams() {
    static const Param params[] = {
        declare(&HeightSource::meshRotate,
                {.id = "meshRotate",
                 .label = "Mesh rotation",
                 .unit = "degrees",
                 .low = -180,
                 .high = 180,
                 .doc = "Turns the mesh about the fixed x, y, z axes before its depth is "
                        "taken along -z."}),
        declare(&HeightSource::margin, {.id = "margin",
                                        .label = "Margin",
                                        .min = 0,
                                        .max = 0.45,
                                        .high = 0.45,
                                        .doc = "Free space around the mesh, as a part of the larger side."}),
        declare(&HeightSource::floorGap,
                {.id = "floorGap",
                 .label = "Floor gap",
                 .min = 0,
                 .max = 1,
                 .doc = "Height of the farthest visible point above the background; the "
                        "nearest has 1."}),
    };
    static const ParamTable table = tableOf<HeightSource>("shape", params);
    return table;
}

namespace {

// A length of a shape: its member, key, label and meaning differ, the rest does not.
template <class Struct, class Member>
Param lengthOf(Member Struct::*member, std::string_view id, std::string_view label, std::string_view doc) {
    return declare(member, {.id = id,
                            .label = label,
                            .unit = "m",
                            .min = kAboveZero,
                            .max = kLargest,
                            .low = 0.01,
                            .high = 10,
                            .logarithmic = true,
                            .group = Group::Shape,
                            .doc = doc,
                            .pair = true});
}

} // namespace

const ParamTable& meshParams() {
    static const Param params[] = {
        declare(&MeshShape::flatNormals,
                {.id = "flatNormals",
                 .label = "Flat normals",
                 .group = Group::Shape,
                 .doc = "The normals of the triangles themselves instead of those interpolated over them."}),
        declare(&MeshShape::textured,
                {.id = "textured",
                 .label = "Textures",
                 .group = Group::Shape,
                 .doc = "Whether the pictures that the file puts on its surface are shown, which multiply "
                        "the colours of the material. Off: the material alone."}),
    };
    static const ParamTable table = tableOf<MeshShape>("shape", params);
    return table;
}

const ParamTable& planeParams() {
    static const Param params[] = {
        lengthOf(&Plane::size, "size", "Size", "Width along x and depth along z.")};
    static const ParamTable table = tableOf<Plane>("shape", params);
    return table;
}

const ParamTable& boxParams() {
    static const Param params[] = {lengthOf(&Box::size, "size", "Size", "Edges along x, y and z.")};
    static const ParamTable table = tableOf<Box>("shape", params);
    return table;
}

const ParamTable& sphereParams() {
    static const Param params[] = {
        lengthOf(&Sphere::radius, "radius", "Radius", "From the centre to the surface.")};
    static const ParamTable table = tableOf<Sphere>("shape", params);
    return table;
}

const ParamTable& torusParams() {
    static const Param params[] = {
        lengthOf(&Torus::major, "major", "Ring radius", "Radius of the circle around the y axis."),
        lengthOf(&Torus::minor, "minor", "Tube radius",
                 "From that circle to the surface; at most the ring radius."),
    };
    static const ParamTable table = tableOf<Torus>("shape", params);
    return table;
}

const ParamTable& cylinderParams() {
    static const Param params[] = {
        lengthOf(&Cylinder::radius, "radius", "Radius", "From the y axis to the side."),
        lengthOf(&Cylinder::height, "height", "Height", "Length along the y axis."),
        declare(&Cylinder::open, {.id = "open",
                                  .label = "Open",
                                  .group = Group::Shape,
                                  .doc = "Without lids: a band or ring, lit from both sides."}),
    };
    static const ParamTable table = tableOf<Cylinder>("shape", params);
    return table;
}

const ParamTable& waterParams() {
    static const Param params[] = {
        lengthOf(&Water::size, "size", "Size", "Width along x and depth along z."),
        declare(
            &Water::cells,
            {.id = "cells",
             .label = "Cells",
             .min = 4,
             .max = 4096,
             .low = 32,
             .high = 512,
             .logarithmic = true,
             .group = Group::Shape,
             .doc = "Heights along the longer side in which the waves are computed. More show finer waves."}),
        declare(&Water::amplitude,
                {.id = "amplitude",
                 .label = "Wave height",
                 .unit = "m",
                 .min = 0,
                 .max = 1e3,
                 .high = 0.05,
                 .group = Group::Waves,
                 .doc = "Height of the sine above the mean, with which the water begins."}),
        declare(&Water::wavelength, {.id = "wavelength",
                                     .label = "Wavelength",
                                     .unit = "m",
                                     .min = kAboveZero,
                                     .max = kLargest,
                                     .low = 0.02,
                                     .high = 2,
                                     .logarithmic = true,
                                     .group = Group::Waves,
                                     .doc = "From crest to crest of that sine."}),
        declare(&Water::direction, {.id = "direction",
                                    .label = "Wave direction",
                                    .min = -kFar,
                                    .max = kFar,
                                    .low = -1,
                                    .group = Group::Waves,
                                    .doc = "The way that sine travels, in x and z.",
                                    .pair = true}),
        declare(&Water::speed, {.id = "speed",
                                .label = "Wave speed",
                                .unit = "m/s",
                                .min = 0,
                                .max = 1e3,
                                .high = 2,
                                .group = Group::Waves,
                                .doc = "How fast every wave travels."}),
        declare(&Water::damping, {.id = "damping",
                                  .label = "Damping",
                                  .unit = "1/s",
                                  .min = 0,
                                  .max = 1e3,
                                  .high = 2,
                                  .group = Group::Waves,
                                  .doc = "How fast waves fade; 0: never."}),
        declare(&Water::dropInterval,
                {.id = "dropInterval",
                 .label = "Time between drops",
                 .unit = "s",
                 .min = 0,
                 .max = 1e6,
                 .high = 5,
                 .group = Group::Waves,
                 .doc = "Seconds between drops that fall at random places; 0: only the pointer's fall."}),
    };
    static const ParamTable table = tableOf<Water>("shape", params);
    return table;
}

const ParamTable& waveParams() {
    static const Param params[] = {
        declare(&Wave::amplitude, {.id = "amplitude",
                                   .label = "Amplitude",
                                   .unit = "m",
                                   .min = -kLargest,
                                   .max = kLargest,
                                   .low = -0.2,
                                   .high = 0.2,
                                   .group = Group::Waves,
                                   .doc = "How far points move along x, y and z; all 0: no wave."}),
        declare(&Wave::direction, {.id = "direction",
                                   .label = "Direction",
                                   .min = -kFar,
                                   .max = kFar,
                                   .low = -1,
                                   .group = Group::Waves,
                                   .doc = "The way the wave travels, in the object's space."}),
        declare(&Wave::wavelength, {.id = "wavelength",
                                    .label = "Wavelength",
                                    .unit = "m",
                                    .min = kAboveZero,
                                    .max = kLargest,
                                    .low = 0.05,
                                    .high = 5,
                                    .logarithmic = true,
                                    .group = Group::Waves,
                                    .doc = "From crest to crest."}),
        declare(&Wave::period, {.id = "period",
                                .label = "Period",
                                .unit = "s",
                                .min = kAboveZero,
                                .max = 1e6,
                                .low = 0.1,
                                .high = 10,
                                .logarithmic = true,
                                .group = Group::Waves,
                                .doc = "Seconds in which a point moves there and back."}),
    };
    static const ParamTable table = tableOf<Wave>("wave", params);
    return table;
}

} // namespace lucent::scene
