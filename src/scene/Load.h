#pragma once
/// From a scene file to a Scene, with every complaint at its place.

#include "base/File.h"
#include "scene/Scene.h"

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lucent::scene {

/// Loads a scene and every file it names.
///
/// @param path        of the scene file; its files are looked up beside it
/// @param read        gives the bytes of the scene and of the files
/// @param techniques  tables of the techniques whose settings may stand under "technique"
/// @return            the scene, complete, or "FILE:LINE: place.key is X; must be Y"
Result<Scene> load(const std::string& path, const ReadFile& read,
                   std::span<const ParamTable* const> techniques);

/// The same step by step, for who must not be kept waiting: what is decoded stays, and the rest is read anew.
class Loading {
public:
    /// @param techniques  must outlive this
    Loading(const std::string& path, ReadFile read, std::span<const ParamTable* const> techniques);
    ~Loading();

    /// Works on until at least one file is decoded and `ms` are over. @return nothing while there is more to
    /// do
    std::optional<Result<Scene>> advance(double ms);

private:
    struct State;
    std::unique_ptr<State> state_;
};

/// Files that a scene names, resolved against its path and in the order of the file: what a page fetches
/// before it calls load().
Result<std::vector<std::string>> dependencies(const std::string& path, std::span<const std::byte> scene);

/// Decodes an environment map; `source` is a file name or a procedural name, for which `bytes` is empty.
Result<std::shared_ptr<const Image>> loadEnvironmentMap(const std::string& source,
                                                        std::span<const std::byte> bytes);

/// JSON Schema (2020-12) of the scene file, written from the parameter tables.
std::string jsonSchema(std::span<const ParamTable* const> techniques);

/// The scene as a scene file: what was loaded with its parameters as they are now. Files keep their names.
std::string toJson(const Scene& scene);

} // namespace lucent::scene
