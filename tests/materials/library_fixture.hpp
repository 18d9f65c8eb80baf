#pragma once
// A material library over scripts and images written in the test.

#include <gtest/gtest.h>

#include "memory_files.hpp"
#include "scene/material.hpp"

namespace q3rt::test {

/// Images "a" to "f" exist (opaque 2x2 TGA), "missing" does not. Add scripts, then use library().
class LibraryFixture : public testing::Test {
  protected:
    LibraryFixture() {
        for (const char* name : {"a", "b", "c", "d", "e", "f"})
            files.addTga(std::string(name) + ".tga");
    }
    /// One script file with one shader "s" of this body.
    void define(std::string_view body) { files.addText("scripts/s.shader", "s\n{\n" + std::string(body) + "\n}\n"); }
    MaterialLibrary& library() {
        if (!m_library) {
            textures.emplace(files, textureSettings);
            m_library.emplace(files, *textures, settings);
            m_library->startVideo = [](std::string_view name) { return name == "v.roq" ? 5 : -1; };
            m_library->setLightmaps({textures->addLightmap(0, page.data()), textures->addLightmap(1, page.data())});
        }
        return *m_library;
    }
    const Material& compile(int lightmap = 0) { return library().get(library().find("s", lightmap)); }
    TextureId textureOf(std::string_view name) { return textures->load(name, {}).value_or(builtinTexture::kDefault); }

    MemoryFiles files;
    TextureSettings textureSettings;
    MaterialSettings settings;
    std::optional<TextureLibrary> textures;
    std::vector<uint8_t> page = std::vector<uint8_t>(128 * 128 * 3, 32);

  private:
    std::optional<MaterialLibrary> m_library;
};

} // namespace q3rt::test
