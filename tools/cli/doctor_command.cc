// `merlin doctor`.
#include <memory>

#include "tools/cli/commands.h"
#include "tools/cli/doctor.h"

namespace merlin::cli {

void AddDoctor(CLI::App& app, int& exit_code) {
  struct Flags {
    bool licenses = false, json = false;
  };
  const auto flags = std::make_shared<Flags>();
  CLI::App* doctor = app.add_subcommand("doctor", "what works here: GL back ends, versions, licences");
  doctor->add_flag("--licenses", flags->licenses, "everything linked, and its terms");
  doctor->add_flag("--json", flags->json, "for machines");
  doctor->callback([flags, &exit_code] { exit_code = Doctor(flags->licenses, flags->json); });
}

}  // namespace merlin::cli
