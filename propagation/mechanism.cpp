#include "propagation/mechanism.h"

namespace emscape::propagation {

Mechanism mechanismOf(PropagationModel model) {
  switch (model) {
    case PropagationModel::free_space:
      return Mechanism::free_space;
    case PropagationModel::horizon:
      return Mechanism::horizon;
    case PropagationModel::diffraction:
      return Mechanism::diffraction;
    case PropagationModel::two_ray:
      return Mechanism::two_ray;
    case PropagationModel::itm:
      return Mechanism::itm;
    case PropagationModel::p528:
      return Mechanism::p528;
    case PropagationModel::p1812:
      return Mechanism::p1812;
    case PropagationModel::p452:
      return Mechanism::p452;
    case PropagationModel::parabolic_equation:
      break;
  }
  return Mechanism::parabolic_equation;
}

std::vector<std::string> mechanismNames() {
  using Model = PropagationModel;
  return {toString(Model::parabolic_equation),
          toString(Model::diffraction),
          toString(Model::two_ray),
          "extended_optics",
          "troposcatter",
          "floor",
          toString(Model::free_space),
          toString(Model::horizon),
          toString(Model::itm),
          toString(Model::p528),
          toString(Model::p1812),
          toString(Model::p452)};
}

}  // namespace emscape::propagation
