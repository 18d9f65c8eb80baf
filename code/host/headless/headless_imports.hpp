#pragma once
// The 40 C functions that HeadlessEngine offers to a module.

#include <string_view>

#include "abi/ref_tables.h"

namespace q3rt {

class HeadlessEngine;

struct HeadlessImports {
    /// The engine that the functions act on.
    static void bind(HeadlessEngine* engine);
    static refimport_t table();

  private:
    static void print(int level, const char* format, ...);
    static bool concernsSetting(std::string_view message);
    static void fail(int code, const char* format, ...);
    static void addCvarImports(refimport_t& t);
    static void addFileImports(refimport_t& t);
    static void addOtherImports(refimport_t& t);
};

} // namespace q3rt
