#include "fem/tangent_assembly.h"

#include <algorithm>
#include <limits>

namespace mortier {
namespace {

/// The first equation of a node; -1 where it has none.
template <int dim>
int firstOf(const std::vector<int>& equations, int node) {
  const int* own = &equations[static_cast<size_t>(dim) * node];
  return *std::max_element(own, own + dim) < 0 ? -1
                                               : *std::find_if(own, own + dim, [](int e) { return e >= 0; });
}

/// Of the equations of a node, those before a component.
template <int dim>
int rankOf(const std::vector<int>& equations, int node, int component) {
  const int* own = &equations[static_cast<size_t>(dim) * node];
  return static_cast<int>(std::count_if(own, own + component, [](int e) { return e >= 0; }));
}

template <int dim>
size_t countOf(const ElementData<dim>& elements) {
  return withElementIn<dim>(elements.nodes.degree, [&](auto element) {
    return elements.weights.size() / decltype(element)::points;
  });
}

template <int dim>
int nodesOfElement(const ElementData<dim>& elements) {
  return withElementIn<dim>(elements.nodes.degree, [](auto element) { return decltype(element)::nodes; });
}

}  // namespace

template <int dim>
TangentAssembly::TangentAssembly(const ElementData<dim>& elements, const Supports& supports, bool symmetric) {
  pattern_.symmetric = symmetric;
  pattern_.size = supports.freeDofs();
  buildPattern(elements, supports.equations());
  cutIntoParts<dim>(supports.equations());
  placeBlocks(elements, supports);
}

template <int dim>
void TangentAssembly::buildPattern(const ElementData<dim>& elements, const std::vector<int>& equations) {
  // The neighbours of each node by counting sort of the elements' couplings, then sorted and made unique one
  // node at a time. Equations ascend with nodes.
  const auto nodes = static_cast<int>(equations.size() / dim);
  const auto n = static_cast<size_t>(nodesOfElement(elements));
  const auto forEachCouplingOf = [&](std::span<const int> of, auto visit) {
    for (const int j : of)
      for (const int i : of)
        if (i >= j || !pattern_.symmetric) visit(i, j);
  };
  const auto forEachCoupling = [&](auto visit) {
    for (int p = 0; elements.patches != nullptr && p < elements.patches->count(); ++p)
      forEachCouplingOf(elements.patches->nodes(p), visit);
    for (size_t t = 0; elements.patches == nullptr && t < countOf(elements); ++t)
      forEachCouplingOf({elements.nodes.of(t), n}, visit);
  };
  std::vector<size_t> start(nodes + 1, 0);
  forEachCoupling([&](int, int of) { ++start[of + 1]; });
  for (int j = 0; j < nodes; ++j) start[j + 1] += start[j];
  std::vector<int> neighbours(start[nodes]);
  std::vector<size_t> next(start.begin(), start.end() - 1);
  forEachCoupling([&](int neighbour, int of) { neighbours[next[of]++] = neighbour; });

  pattern_.columnStart.assign(1, 0);
  pattern_.columnStart.reserve(pattern_.size + 1);
  for (int j = 0; j < nodes; ++j) {
    const auto begin = neighbours.begin() + static_cast<std::ptrdiff_t>(start[j]);
    const auto last = neighbours.begin() + static_cast<std::ptrdiff_t>(start[j + 1]);
    std::sort(begin, last);
    const auto end = std::unique(begin, last);
    for (int c = 0; c < dim; ++c) {
      const int column = equations[static_cast<size_t>(dim) * j + c];
      if (column < 0) continue;
      for (auto node = begin; node != end; ++node)
        for (int r = 0; r < dim; ++r) {
          const int row = equations[static_cast<size_t>(dim) * *node + r];
          if (row >= 0 && (row >= column || !pattern_.symmetric)) pattern_.rows.push_back(row);
        }
      pattern_.columnStart.push_back(static_cast<int>(pattern_.rows.size()));
    }
  }
}

template <int dim>
int TangentAssembly::place(const std::vector<int>& equations, int node, int of) const {
  const int column = firstOf<dim>(equations, of);
  const int row = firstOf<dim>(equations, node);
  if (column < 0 || row < 0 || (row < column && pattern_.symmetric)) return -1;
  const auto begin = pattern_.rows.begin() + pattern_.columnStart[column];
  const auto end = pattern_.rows.begin() + pattern_.columnStart[column + 1];
  return static_cast<int>(std::lower_bound(begin, end, row) - begin);
}

template <int dim, class PlaceOf, class Entries>
void TangentAssembly::add(const std::vector<int>& equations, std::span<const int> nodes,
                          const PlaceOf& placeOf, const Entries& entries, std::vector<double>& values) const {
  const auto n = static_cast<int>(nodes.size());
  for (int b = 0; b < n; ++b)
    for (int a = 0; a < n; ++a) {
      const int block = placeOf(a, b);
      if (block < 0) continue;
      int rankOfColumn = 0;
      for (int c = 0; c < dim; ++c) {
        const int column = equations[static_cast<size_t>(dim) * nodes[b] + c];
        if (column < 0) continue;
        int at = pattern_.columnStart[column] + block - (pattern_.symmetric ? rankOfColumn : 0);
        ++rankOfColumn;
        for (int r = 0; r < dim; ++r) {
          const int row = equations[static_cast<size_t>(dim) * nodes[a] + r];
          if (row < 0) continue;
          if (row >= column || !pattern_.symmetric) values[at] += entries(dim * a + r, dim * b + c);
          ++at;
        }
      }
    }
}

template <int dim>
void TangentAssembly::cutIntoParts(const std::vector<int>& equations) {
  constexpr int columnsOfAPart = 8192;
  // Between nodes.
  for (int node = 0; node < static_cast<int>(equations.size() / dim); ++node) {
    const int first = firstOf<dim>(equations, node);
    if (first < static_cast<int>(parts_.size()) * columnsOfAPart) continue;
    if (!parts_.empty()) parts_.back().endColumn = first;
    parts_.push_back({first, pattern_.size, {}});
  }
}

template <int dim>
void TangentAssembly::placeBlocks(const ElementData<dim>& elements, const Supports& supports) {
  const std::vector<int>& equations = supports.equations();
  const auto isPlain = [&](int node) {
    const int* own = &equations[static_cast<size_t>(dim) * node];
    return *std::min_element(own, own + dim) >= 0 && supports.frameOf(node) == nullptr;
  };
  const auto partOf = [&](int column) {
    const auto after = std::upper_bound(parts_.begin(), parts_.end(), column,
                                        [](int value, const Part& part) { return value < part.firstColumn; });
    return static_cast<int>(after - parts_.begin()) - 1;
  };
  for (int p = 0; elements.patches != nullptr && p < elements.patches->count(); ++p)
    for (const int of : elements.patches->nodes(p))
      for (const int node : elements.patches->nodes(p))
        placesOfPatches_.push_back(place<dim>(equations, node, of));
  const int n = nodesOfElement(elements);
  const size_t count = countOf(elements);
  blocks_.resize(count * n * n);
  std::vector<int> home(n);
  for (size_t t = 0; t < count; ++t) {
    const int* nodes = elements.nodes.of(t);
    uint16_t* blocks = &blocks_[t * n * n];
    bool plain = std::all_of(nodes, nodes + n, isPlain);
    for (int b = 0; b < n && plain; ++b) {
      home[b] = partOf(firstOf<dim>(equations, nodes[b]));
      for (int a = 0; a < n; ++a) {
        const int block = place<dim>(equations, nodes[a], nodes[b]);
        if (block < 0) continue;
        plain = plain && block <= std::numeric_limits<uint16_t>::max();
        blocks[n * b + a] = static_cast<uint16_t>(block);
      }
    }
    if (!plain) {
      others_.push_back(static_cast<int>(t));
      continue;
    }
    std::sort(home.begin(), home.end());
    for (int b = 0; b < n; ++b)
      if (b == 0 || home[b] != home[b - 1]) parts_[home[b]].elements.push_back(static_cast<int>(t));
  }
  for (Part& part : parts_) part.elements.shrink_to_fit();
}

// All rows of a node follow each other in every column, and its further columns are its first one (where
// symmetric: without the first rows). Every entry is a sum over elements in their order, whichever part it
// lies in.
template <int dim, class At>
void TangentAssembly::assemblePlain(const ElementData<dim>& elements, const std::vector<int>& equations,
                                    const TangentModuli& moduli, std::vector<double>& values,
                                    Threads& threads) const {
  using Element = typename At::Element;
  using Block = Eigen::Vector<double, dim>;
  constexpr int n = Element::nodes;
  constexpr int points = Element::points;
  values.resize(pattern_.entries());
  const bool symmetric = pattern_.symmetric;
  double* const first = values.data();
  const int* const start = pattern_.columnStart.data();
  threads.forEach(static_cast<int>(parts_.size()), [&](int p) {
    const Part& part = parts_[p];
    std::fill(values.begin() + start[part.firstColumn], values.begin() + start[part.endColumn], 0.0);
    for (const int t : part.elements) {
      const int* nodes = elements.nodes.of(t);
      const uint16_t* blocks = &blocks_[static_cast<size_t>(n) * n * t];
      int equation[n];
      for (int a = 0; a < n; ++a) equation[a] = equations[static_cast<size_t>(dim) * nodes[a]];
      const auto forEachOwn = [&](const auto& visit) {
        for (int b = 0; b < n; ++b)
          if (equation[b] >= part.firstColumn && equation[b] < part.endColumn) visit(b);
      };
      if constexpr (dim == 2) {  // written out: loops over the columns cost half of the time more
        for (int i = points * t; i < points * (t + 1); ++i) {
          const At at(elements, moduli, i);
          forEachOwn([&](int b) {
            const auto columns = at.columns(b);
            double* columnX = first + start[equation[b]];
            double* columnY = first + start[equation[b] + 1] - (symmetric ? 1 : 0);
            for (int a = 0; a < n; ++a) {
              if (symmetric && equation[a] < equation[b]) continue;
              const int block = blocks[n * b + a];
              const Block yy = at.rows(columns[1], a);
              Eigen::Map<Block>{columnX + block} += at.rows(columns[0], a);
              if (symmetric && a == b)
                columnY[block + 1] += yy[1];
              else
                Eigen::Map<Block>{columnY + block} += yy;
            }
          });
        }
      } else {  // The sums over points come first: their rounding is that of an element.
        Eigen::Matrix<double, dim * n, dim* n> K = Eigen::Matrix<double, dim * n, dim * n>::Zero();
        for (int i = points * t; i < points * (t + 1); ++i) At(elements, moduli, i).addTo(K);
        forEachOwn([&](int b) {
          for (int a = 0; a < n; ++a)
            for (int c = 0; c < dim && !(symmetric && equation[a] < equation[b]); ++c) {
              double* to = first + start[equation[b] + c] - (symmetric ? c : 0) + blocks[n * b + a];
              for (int r = symmetric && a == b ? c : 0; r < dim; ++r) to[r] += K(dim * a + r, dim * b + c);
            }
        });
      }
    }
  });
}

template <int dim, class At>
void TangentAssembly::addOthers(const ElementData<dim>& elements, const Supports& supports,
                                const TangentModuli& moduli, std::vector<double>& values,
                                Threads& threads) const {
  using Element = typename At::Element;
  constexpr int n = Element::nodes;
  using Stiffness = Eigen::Matrix<double, dim * n, dim * n>;
  const auto stiffnessOf = [&](int t, Stiffness& K) {
    K.setZero();
    for (int i = Element::points * t; i < Element::points * (t + 1); ++i) {
      const At at(elements, moduli, i);
      for (int b = 0; b < n; ++b) {
        const auto columns = at.columns(b);
        for (int a = 0; a < n; ++a)
          for (int c = 0; c < dim; ++c)
            K.template block<dim, 1>(dim * a, dim * b + c) += at.rows(columns[c], a);
      }
    }
    // Motions along the frames of the nodes.
    for (int a = 0; a < n; ++a)
      if (const Eigen::Matrix3d* whole = supports.frameOf(elements.nodes.of(t)[a]); whole != nullptr) {
        const Eigen::Matrix<double, dim, dim> frame = whole->topLeftCorner<dim, dim>();
        K.template middleRows<dim>(dim * a) = (frame * K.template middleRows<dim>(dim * a)).eval();
        K.template middleCols<dim>(dim * a) =
            (K.template middleCols<dim>(dim * a) * frame.transpose()).eval();
      }
  };
  // The matrices of some at once, then their sums in the order of the elements.
  constexpr size_t atOnce = 1024;
  constexpr size_t ofABlock = 32;
  std::vector<Stiffness> matrices(std::min(atOnce, others_.size()));
  for (size_t first = 0; first < others_.size(); first += atOnce) {
    const size_t count = std::min(atOnce, others_.size() - first);
    threads.forEach(static_cast<int>((count + ofABlock - 1) / ofABlock), [&](int block) {
      for (size_t k = ofABlock * block; k < std::min(count, ofABlock * (block + 1)); ++k)
        stiffnessOf(others_[first + k], matrices[k]);
    });
    for (size_t k = 0; k < count; ++k) {
      const int* nodes = elements.nodes.of(others_[first + k]);
      add<dim>(
          supports.equations(), {nodes, n},
          [&](int a, int b) { return place<dim>(supports.equations(), nodes[a], nodes[b]); }, matrices[k],
          values);
    }
  }
}

template <int dim, class At>
void TangentAssembly::addPatches(const ElementData<dim>& elements, const Supports& supports,
                                 const TangentModuli& moduli, std::vector<double>& values,
                                 Threads& threads) const {
  using Element = typename At::Element;
  constexpr int ofABlock = 256;
  const VolumePatches& patches = *elements.patches;
  const auto setPatch = [&](int patch, double* memory) {
    PatchTangent tangent(patches, patch, dim, memory);
    tangent.start(patches, patch);
    Eigen::Matrix3d inner = Eigen::Matrix3d::Zero();
    for (const int t : patches.elements(patch)) {
      const int* local = patches.local(t);
      for (int i = Element::points * t; i < Element::points * (t + 1); ++i) {
        const At at(elements, moduli, i);
        const auto row = at.volumeColumn();
        const auto column = at.volumeRow();
        const double* basis = patches.basis(i);
        for (int k = 0; k < patches.terms(); ++k) {
          const double w = at.weight() * basis[k];
          for (int l = 0; l <= k; ++l) inner(k, l) += w * basis[l] * at.volume();
          for (int a = 0; a < Element::nodes; ++a) {
            Eigen::Map<Eigen::Vector<double, dim>>{tangent.first(k) + dim * local[a]} += w * at.rows(row, a);
            Eigen::Map<Eigen::Vector<double, dim>>{tangent.second(k) + dim * local[a]} +=
                w * at.rows(column, a);
          }
        }
      }
    }
    tangent.addInner(inner);
    const auto nodes = patches.nodes(patch);
    for (size_t a = 0; a < nodes.size(); ++a)
      if (const Eigen::Matrix3d* frame = supports.frameOf(nodes[a]); frame != nullptr)
        tangent.turnNode(dim * a, [&](double* at) {
          Eigen::Map<Eigen::Vector<double, dim>> vector(at);
          vector = (frame->topLeftCorner<dim, dim>() * vector).eval();
        });
  };
  const int* places = placesOfPatches_.data();
  const auto addPatch = [&](int patch, double* memory) {
    const auto nodes = patches.nodes(patch);
    const auto n = static_cast<int>(nodes.size());
    add<dim>(
        supports.equations(), nodes, [&](int a, int b) { return places[n * b + a]; },
        PatchTangent(patches, patch, dim, memory), values);
    places += static_cast<std::ptrdiff_t>(n) * n;
  };
  std::vector<double> work;
  constexpr int atOnce = 64 * ofABlock;
  for (int first = 0; first < patches.count(); first += atOnce) {
    const int end = std::min(first + atOnce, patches.count());
    std::vector<size_t> from(1, 0);
    for (int patch = first; patch < end; ++patch)
      from.push_back(from.back() + PatchTangent::need(patches, patch, dim));
    work.resize(from.back());
    threads.forEach((end - first + ofABlock - 1) / ofABlock, [&](int block) {
      for (int patch = first + ofABlock * block; patch < std::min(end, first + ofABlock * (block + 1));
           ++patch)
        setPatch(patch, work.data() + from[patch - first]);
    });
    for (int patch = first; patch < end; ++patch) addPatch(patch, work.data() + from[patch - first]);
  }
}

template <int dim, class At>
void TangentAssembly::assembleAt(const ElementData<dim>& elements, const Supports& supports,
                                 const TangentModuli& moduli, std::vector<double>& values,
                                 Threads& threads) const {
  assemblePlain<dim, At>(elements, supports.equations(), moduli, values, threads);
  addOthers<dim, At>(elements, supports, moduli, values, threads);
  if (elements.patches != nullptr) addPatches<dim, At>(elements, supports, moduli, values, threads);
}

template <int dim>
void TangentAssembly::assemble(const ElementData<dim>& elements, const Supports& supports,
                               const TangentModuli& moduli, std::vector<double>& values,
                               Threads& threads) const {
  withPointsOf(elements, [&](auto point) {
    assembleAt<dim, typename decltype(point)::type>(elements, supports, moduli, values, threads);
  });
}

template TangentAssembly::TangentAssembly(const ElementData<2>&, const Supports&, bool);
template TangentAssembly::TangentAssembly(const ElementData<3>&, const Supports&, bool);
template void TangentAssembly::assemble(const ElementData<2>&, const Supports&, const TangentModuli&,
                                        std::vector<double>&, Threads&) const;
template void TangentAssembly::assemble(const ElementData<3>&, const Supports&, const TangentModuli&,
                                        std::vector<double>&, Threads&) const;

}  // namespace mortier
