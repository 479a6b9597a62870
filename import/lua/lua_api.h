#pragma once

// Lua as C++ compiles it, whose functions Debian 12 calls by names of C and Debian 13 by those of
// C++ (import/CMakeLists.txt finds out).
#ifdef HYADES_LUA_HAS_CXX_NAMES
#include <lauxlib.h>
#include <lua.h>
#include <lualib.h>
#else
#include <lua.hpp>
#endif
