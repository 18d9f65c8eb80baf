#pragma once
// A window with nothing in it, for modules that draw nothing: the engine's input code needs one, and only a renderer
// can make it. SDL is loaded when a window is wanted, so that the same module runs where there is no SDL.

#include <cstdint>

#include "engine/renderer.hpp"

namespace q3rt {

class NullDisplay {
  public:
    explicit NullDisplay(EngineServices& engine)
        : m_engine(engine) {}
    ~NullDisplay();
    NullDisplay(const NullDisplay&) = delete;
    NullDisplay& operator=(const NullDisplay&) = delete;

    /// Opens the window the first time if the host wants one. Size from r_mode, r_customwidth and r_customheight.
    DisplayInfo open();

  private:
    void openWindow(int width, int height);
    template <class Function>
    Function* find(const char* name);

    EngineServices& m_engine;
    void* m_library = nullptr;
    void* m_window = nullptr;
};

} // namespace q3rt
