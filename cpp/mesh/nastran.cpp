#include "mesh/nastran.h"

#include <fstream>
#include <string_view>
#include <utility>
#include <vector>

#include "base/error.h"

namespace mortier {
namespace {

std::string withoutBlanks(std::string_view text) {
  constexpr auto blanks = " \t\r";
  const size_t begin = text.find_first_not_of(blanks);
  return begin == text.npos ? "" : std::string(text.substr(begin, text.find_last_not_of(blanks) + 1 - begin));
}

/// The name of a card and its fields, up to the last that is not blank.
std::vector<std::string> fieldsOf(std::string_view line) {
  constexpr size_t name = 8;
  std::vector<std::string> fields;
  if (line.find(',') != line.npos) {
    for (size_t at = 0, end = 0; end != line.npos; at = end + 1) {
      end = line.find(',', at);
      fields.push_back(withoutBlanks(line.substr(at, end == line.npos ? end : end - at)));
    }
  } else {
    const size_t width = line.substr(0, name).find('*') == line.npos ? 8 : 16;
    for (size_t at = 0; at < line.size(); at += at == 0 ? name : width)
      fields.push_back(withoutBlanks(line.substr(at, at == 0 ? name : width)));
  }
  while (!fields.empty() && (fields.back().empty() || fields.back().starts_with('+'))) fields.pop_back();
  return fields;
}

/// Of the number, the property and the nodes of an element; 0 of another card.
size_t fieldsRead(const std::string& card) {
  constexpr std::pair<std::string_view, size_t> elements[]{
      {"CROD", 4},    {"CBAR", 4},    {"CTRIA3", 5}, {"CQUAD4", 6},  {"CTRIA6", 8},
      {"CQUAD8", 10}, {"CTETRA", 12}, {"CPYRA", 15}, {"CPENTA", 17}, {"CHEXA", 22}};
  for (const auto& [name, fields] : elements)
    if (card.starts_with(name)) return fields;
  return 0;
}

}  // namespace

void requireCardsOfGmsh(const std::string& path) {
  std::ifstream file(path);
  std::string line, card;
  constexpr size_t fieldsOfLongLine = 4;
  size_t read = 0;  // fields of the card on its earlier lines
  for (int number = 1; std::getline(file, line); ++number) {
    const std::vector<std::string> fields = fieldsOf(line);
    if (fields.empty() || fields[0].starts_with('$')) continue;
    const auto refuse = [&](const std::string& what) {
      throw InputError(path + ":" + std::to_string(number) + ": " + what);
    };
    const bool continues = fields[0].empty() || fields[0].starts_with('+') || fields[0] == "*";
    if (!continues) card = fields[0], read = 0;
    if (card == "grid" || card == "Grid") refuse(card + ", expected cards in capital letters");
    if (!continues && card.starts_with("GRID") && fields.size() > 2 && !fields[2].empty() && fields[2] != "0")
      refuse("node " + fields[1] + " in the system of coordinates " + fields[2] +
             ", expected places in the basic system");
    const auto refuseBlank = [&](const std::string& where) {
      refuse(card + ": " + where +
             " is blank, expected a number (a blank property is the number of the element)");
    };
    if (continues && read < fieldsRead(card) && read % fieldsOfLongLine != 0)
      refuseBlank("the last field of the line before");
    for (size_t k = 1; k < fields.size() && read < fieldsRead(card); ++k, ++read)
      if (fields[k].empty()) refuseBlank("field " + std::to_string(k + 1) + " of this line");
  }
}

}  // namespace mortier
