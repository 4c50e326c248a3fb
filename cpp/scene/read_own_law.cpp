#include <cctype>
#include <cmath>

#include "base/error.h"
#include "scene/formulas.h"
#include "scene/readers.h"
#include "scene/registered_laws.h"

namespace mortier {
namespace {

/// Of stress and strain, in the plane and in space.
const std::vector<std::string> planeComponents{"s11", "s22", "s12", "s33", "e11", "e22", "e12", "e33"};
const std::vector<std::string> spaceComponents{"s11", "s22", "s12", "s33", "s13", "s23",
                                               "e11", "e22", "e12", "e33", "e13", "e23"};

template <int n>
class ExpressionLaw final : public RateLaw {
 public:
  explicit ExpressionLaw(Formulas rates) : rates_(std::move(rates)) {
    for (int k = n; k < 2 * n; ++k) needsTotalStrain_ = needsTotalStrain_ || rates_.dependsOn(k);
  }
  [[nodiscard]] bool needsTotalStrain() const override { return needsTotalStrain_; }
  [[nodiscard]] bool takes(int components) const override { return components == n; }
  void evaluate(const Matrix& stress, const Matrix& strain, Matrix& rate, Matrix* slopes) const override {
    const auto rateOf = [&]<class Number>(const Number* in, Number* out, int points) {
      thread_local std::vector<Number> work;
      rates_.evaluate(in, out, points, work);
    };
    if (needsTotalStrain_)
      evaluateBlocks<n, true>(rateOf, stress, strain, rate, slopes);
    else
      evaluateBlocks<n, false>(rateOf, stress, strain, rate, slopes);
  }

 private:
  Formulas rates_;
  bool needsTotalStrain_ = false;
};

/// Whether an expression may hold it.
bool isWord(const std::string& name) {
  if (name.empty() || std::isdigit(static_cast<unsigned char>(name.front())) != 0) return false;
  for (const unsigned char c : name)
    if (std::isalnum(c) == 0 && c != '_') return false;
  return true;
}

Formulas::Text textOf(const TableReader& table, const std::string& name, const Node& node) {
  const std::string where = table.message(node.where, name + " = " + node.quoted());
  if (node.isNumeric() && std::isfinite(node.value)) return {shortest(node.value), where};
  if (!node.isString()) throw InputError(where + ", expected a finite number or an expression");
  return {node.text, where};
}

std::map<std::string, const Node*> parametersOf(const TableReader& table) {
  std::map<std::string, const Node*> result;
  const Node* parameters = table.find("parameters");
  if (parameters == nullptr) return result;
  if (!parameters->isTable()) table.reject("parameters", "a table, { eta = 10, ... }");
  for (const Node& each : parameters->members) {
    if (!isWord(each.key))
      table.refuse(each, "parameters." + each.key + ", expected a name of letters, digits and _");
    result[each.key] = &each;
  }
  return result;
}

}  // namespace

OwnLaw readExpressionLaw(const TableReader& table) {
  const bool space = table.table().inSpace;
  const std::vector<std::string>& components = space ? spaceComponents : planeComponents;
  requireOfDimension(table, {"rate13", "rate23"}, {});
  OwnLaw own;
  own.name = "expression";
  own.texts.emplace();
  std::map<std::string, Formulas::Text> named;
  for (const auto& [name, node] : parametersOf(table)) {
    if (isOneOf(name, components) || Formulas::isWord(name))
      table.refuse(*node,
                   "parameters." + name + ", expected another name than those of components and functions");
    named[name] = textOf(table, "parameters." + name, *node);
    own.texts->named[name] = named[name].text;
    if (node->isNumeric()) own.parameters[name] = node->value;
  }
  Formulas rates(components, named);
  for (const std::string key : {"rate11", "rate22", "rate12", "rate33", "rate13", "rate23"}) {
    if (!space && key == "rate13") break;
    if (key == "rate33") own.inPlaneStrain = table.find(key) != nullptr;
    if (space || own.inPlaneStrain) {
      const Formulas::Text text =
          textOf(table, key, table.require(key, "an expression of the stress, [1/s]"));
      own.texts->rates.push_back(text.text);
      rates.add(text);
    } else {
      rates.add({"0", ""});
    }
  }
  // One that is not used is read too: what is wrong in it is wrong.
  Formulas all = rates;
  for (const auto& [name, text] : named) all.add({name, text.where});
  if (space)
    own.law = std::make_shared<ExpressionLaw<6>>(std::move(rates));
  else
    own.law = std::make_shared<ExpressionLaw<4>>(std::move(rates));
  own.isotropic = table.boolean("isotropic");
  const Node& first = table.require("rate11", "");
  own.where = table.message(first.where, "law = \"expression\"");
  return own;
}

OwnLaw readRegisteredLaw(const TableReader& table) {
  OwnLaw own;
  own.name = table.string("law");
  own.where = table.message(table.find("law")->where, "law = \"" + own.name + '"');
  for (const auto& [name, node] : parametersOf(table)) {
    const auto [text, where] = textOf(table, "parameters." + name, *node);
    if (!node->isNumeric()) throw InputError(where + ", expected a finite number");
    own.parameters[name] = node->value;
  }
  const LawParameters parameters(own.parameters, own.where);
  own.law = registeredLaw(own.name)(parameters);
  parameters.requireAllUsed();
  own.isotropic = table.boolean("isotropic");
  return own;
}

}  // namespace mortier
