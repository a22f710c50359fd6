/// The ground of pictures and the references on it, derived from the view when something differs.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "emscape/base/error.h"
#include "emscape/playback/view/view_state.h"
#include "playback/frames/ground_marks.h"

namespace emscape::playback {

/// For one thread.
class Scenery {
 public:
  /// Adapts to a view, a scene (which may be null) and the grid of the frame.
  /// @return true if heightField() is another one
  bool update(const ViewState& view, const LoadedScenario* scene, const volume::Grid& grid);
  /// The fault of a file that the view names, since the last call of this function; each is reported once.
  std::optional<Error> takeFault();

  /// The drawn ground; null if there is none.
  const std::shared_ptr<const render::HeightField>& heightField() const { return drawn_; }
  /// Sets lines and points on the ground, and the words of the axes.
  void annotate(render::Annotations& annotations, const ViewState& view,
                const std::vector<render::Marker>& markers) const;

 private:
  void updateCoast(const ViewState& view);
  bool updateGround(const ViewState& view);
  void updatePlaces(const std::vector<std::string>& files);
  void updateMarks(const ViewState& view);
  const LoadedScenario* scene() const { return scene_ ? &*scene_ : nullptr; }

  std::optional<LoadedScenario> scene_;
  std::optional<volume::Grid> grid_;
  bool has_ground_ = false;  ///< below the grid
  bool reads_coast_ = false;
  std::shared_ptr<const scenario::Coast> coast_;

  std::shared_ptr<render::HeightField> ground_;  ///< without drape and theme
  bool is_fine_ = false;
  bool is_sea_by_heights_ = false;
  std::string drape_;
  std::vector<render::Category> ground_classes_;  ///< of the drape
  std::shared_ptr<const render::HeightField> drawn_;

  std::vector<std::string> place_files_;
  struct PlacesOfFile {
    std::string file;
    std::vector<scenario::Place> places;
    bool is_told_outside = false;  ///< of the area of grid_
  };
  std::vector<PlacesOfFile> places_;

  std::optional<ViewState> marked_;  ///< the view of the marks
  std::vector<render::GroundLine> lines_;
  std::vector<render::GroundPoint> points_;
  std::optional<Error> fault_;
};

}  // namespace emscape::playback
