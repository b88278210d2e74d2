// SPDX-License-Identifier: MIT
#include "chicane/recording/detail/stroke_font.hpp"

#include <array>
#include <string_view>

namespace chicane::recording {
namespace {

/// Lines between points of a grid, 0 to 4 to the right and 0 to 6 upwards: "04 44" is a stroke from (0, 4) to
/// (4, 4), a comma lifts the pen.
struct Glyph {
  char letter;
  std::string_view path;
};

constexpr std::array kGlyphs{
    Glyph{'0', "10 01 05 16 36 45 41 30 10,11 35"},
    Glyph{'1', "15 26 20,10 30"},
    Glyph{'2', "05 16 36 45 44 00 40"},
    Glyph{'3', "05 16 36 45 44 33 13,33 42 41 30 10 01"},
    Glyph{'4', "30 36 02 42"},
    Glyph{'5', "46 06 03 33 42 41 30 10 01"},
    Glyph{'6', "45 36 16 05 01 10 30 41 42 33 03"},
    Glyph{'7', "06 46 10"},
    Glyph{'8', "13 04 05 16 36 45 44 33 13 02 01 10 30 41 42 33"},
    Glyph{'9', "01 10 30 41 45 36 16 05 04 13 43"},
    Glyph{'A', "00 04 26 44 40,03 43"},
    Glyph{'B', "00 06 36 45 44 33 03,33 42 41 30 00"},
    Glyph{'C', "45 36 16 05 01 10 30 41"},
    Glyph{'D', "00 06 26 44 42 20 00"},
    Glyph{'E', "40 00 06 46,03 33"},
    Glyph{'F', "00 06 46,03 33"},
    Glyph{'G', "45 36 16 05 01 10 30 41 43 23"},
    Glyph{'H', "00 06,40 46,03 43"},
    Glyph{'I', "10 30,20 26,16 36"},
    Glyph{'J', "01 10 20 31 36"},
    Glyph{'K', "00 06,46 03 40"},
    Glyph{'L', "06 00 40"},
    Glyph{'M', "00 06 23 46 40"},
    Glyph{'N', "00 06 40 46"},
    Glyph{'O', "10 01 05 16 36 45 41 30 10"},
    Glyph{'P', "00 06 36 45 44 33 03"},
    Glyph{'Q', "10 01 05 16 36 45 41 30 10,22 40"},
    Glyph{'R', "00 06 36 45 44 33 03,23 40"},
    Glyph{'S', "45 36 16 05 04 13 33 42 41 30 10 01"},
    Glyph{'T', "20 26,06 46"},
    Glyph{'U', "06 01 10 30 41 46"},
    Glyph{'V', "06 20 46"},
    Glyph{'W', "06 10 23 30 46"},
    Glyph{'X', "00 46,06 40"},
    Glyph{'Y', "06 23 46,23 20"},
    Glyph{'Z', "06 46 00 40"},
    Glyph{'.', "20 21"},
    Glyph{',', "10 21"},
    Glyph{':', "21 22,24 25"},
    Glyph{'+', "03 43,21 25"},
    Glyph{'-', "03 43"},
    Glyph{'_', "00 40"},
    Glyph{'/', "00 46"},
    Glyph{'%', "00 46,04 05,41 42"},
    Glyph{'(', "30 21 25 36"},
    Glyph{')', "10 21 25 16"},
};

constexpr double kAcross = 0.15, kUp = 1.0 / 6.0;  // of the grid, in sizes

}  // namespace

void for_each_stroke(char letter, const std::function<void(double, double, double, double)>& stroke) {
  if (letter >= 'a' && letter <= 'z') letter = static_cast<char>(letter - 'a' + 'A');
  for (const Glyph& glyph : kGlyphs) {
    if (glyph.letter != letter) continue;
    for (std::size_t i = 0; i + 4 < glyph.path.size(); i += 3) {
      if (glyph.path[i + 2] == ',') continue;
      const auto across = [&](std::size_t at) { return kAcross * (glyph.path[at] - '0'); };
      const auto up = [&](std::size_t at) { return kUp * (glyph.path[at + 1] - '0'); };
      stroke(across(i), up(i), across(i + 3), up(i + 3));
    }
    return;
  }
}

}  // namespace chicane::recording
