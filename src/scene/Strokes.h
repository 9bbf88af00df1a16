#pragma once
/// Strokes in JSON, inside scene files and in scripts of their own.

#include "base/JsonWriter.h"
#include "scene/JsonReading.h"
#include "scene/Painting.h"

namespace lucent::scene {

/// Reads a list of strokes that stands at a place of the file `path`.
Result<std::vector<Stroke>> strokesFrom(const Place& list, const std::string& path);
/// Writes the list that reads back to the same strokes.
void writeStrokes(JsonWriter& json, std::span<const Stroke> strokes);

} // namespace lucent::scene
