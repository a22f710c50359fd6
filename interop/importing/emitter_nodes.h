/// Emitters of a scenario from the beams of a recording and the database.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "emscape/scenario/model/emitter.h"
#include "interop/emitters/emitter_database.h"
#include "interop/import_scenario.h"
#include "interop/importing/beam_pieces.h"
#include "interop/importing/nodes.h"

namespace emscape::interop {

/// Names that are in use; each is given once.
class UniqueNames {
 public:
  /// The name, with a number if it is in use; printable, at most 150 characters.
  std::string unique(const std::string& name);
  /// The names that needed a number.
  const std::vector<std::string>& numbered() const { return numbered_; }

 private:
  std::set<std::string> used_;
  std::vector<std::string> numbered_;
};

/// Makes emitters and counts what was matched.
class EmitterMaker {
 public:
  /// @param folder  of the scenario, for the names of antenna files
  /// @param window  times of the scenario
  EmitterMaker(const EmitterDatabase& database, std::filesystem::path folder, BeamwidthMeaning beamwidth,
               TimeSpan window, UniqueNames& names)
      : database_(database),
        folder_(std::move(folder)),
        beamwidth_(beamwidth),
        window_(window),
        names_(names) {}

  /// The emitters of an object, for a platform of the given name.
  /// @param beams  of the object; without any the object has the emitter of the row that matches it
  /// @param present  emitters that the platform has in the base: none of their names and kinds is added
  /// @param height_m  receives the largest height of their antennas above the object's reference point
  std::vector<DocumentNodePtr> make(const RecordedObject& object,
                                    const std::vector<const RecordedBeam*>& beams,
                                    const std::string& platform,
                                    const std::vector<const scenario::Emitter*>& present, double& height_m);

  /// What was made and what was not.
  std::vector<ImportedEmitters> uses() const { return uses_; }
  std::vector<std::string> notes() const;

 private:
  struct Origin {
    DocumentNodePtr emitter;
    std::string name, source, file;
    double height_m = 0;
  };

  void makeOfBeam(const RecordedObject& object, const RecordedBeam& beam,
                  const std::vector<TimeSpan>& presence, const std::string& platform,
                  const std::vector<const scenario::Emitter*>& present, double& height_m,
                  std::vector<DocumentNodePtr>& emitters);
  /// What the emitter of a beam is made from; without an emitter if nothing matches.
  Origin originOf(const RecordedObject& object, const RecordedBeam& beam) const;
  /// @param fault  receives the reason if the result is null
  DocumentNodePtr emitterNode(const Origin& origin, const BeamPiece* piece,
                              const std::vector<TimeSpan>& active, const std::string& name,
                              const std::string& platform, std::string& fault);
  void setPower(MapBuilder& emitter, const Origin& origin, const BeamPiece* piece, std::string& fault) const;
  void setScan(MapBuilder& emitter, const BeamPiece& piece);
  DocumentNodePtr antennaOfSweep(const BeamState& state) const;
  void count(const std::string& name, const std::string& source, const std::string& fault);

  const EmitterDatabase& database_;
  std::filesystem::path folder_;
  BeamwidthMeaning beamwidth_;
  TimeSpan window_;
  UniqueNames& names_;
  std::vector<ImportedEmitters> uses_;
  int sectors_ = 0, beams_cut_ = 0, assumed_turns_ = 0;
};

}  // namespace emscape::interop
