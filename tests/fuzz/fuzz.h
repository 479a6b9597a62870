#pragma once

#include <string>
#include <string_view>
#include <vector>

/// A fuzz target is a program that gives any bytes to one reader. Each has one source file here
/// with these two functions. Built with HYADES_FUZZ=ON (Clang) it is a libFuzzer program; else
/// steady_driver.cpp drives it, without feedback, for the suite.
namespace hyades::fuzz {

/// Inputs that the reader takes, to begin with: the steady driver demands that it does.
std::vector<std::string> seeds();

/// Reads `input`; whether the reader took it. Returns whatever it is: a crash, a sanitizer's
/// complaint, more memory or time than the driver allows is a bug. A target that finds a promise
/// broken calls std::abort().
bool try_input(std::string_view input);

}  // namespace hyades::fuzz
