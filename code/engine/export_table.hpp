#pragma once
// The C face of a renderer module: the engine's export table around one Renderer. A module is
//   std::unique_ptr<Renderer> q3rt::createRenderer(EngineServices&)   and   Q3RT_EXPORT_MODULE
// in its module.cpp, linked by q3rt_module() of cmake/module.cmake.

#include "abi/ref_tables.h"

namespace q3rt {

/// The table for the engine, or null if it speaks another version of the interface.
refexport_t* makeExportTable(int apiVersion, const refimport_t* imports);

} // namespace q3rt

/// Defines the one symbol that a module exports.
#define Q3RT_EXPORT_MODULE                                                                                             \
    extern "C" [[gnu::visibility("default")]] refexport_t* GetRefAPI(int apiVersion, refimport_t* imports) {           \
        return q3rt::makeExportTable(apiVersion, imports);                                                             \
    }
