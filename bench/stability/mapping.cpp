#include "bench/stability/mapping.h"

#include <fmt/format.h>

#include "bench/cases/executor.h"
#include "core/interruption.h"

namespace poinsot::stability {

std::vector<Mapped> map_families(const std::vector<const Family*>& families, const Extent& extent,
                                 const Mapping& mapping, const MapsTold& told) {
  double all = 0, done = 0;
  for (const Family* family : families) all += static_cast<double>(FamilyStudy(*family, extent).study().size());
  std::vector<Mapped> maps;
  for (const Family* family : families) {
    const FamilyStudy study(*family, extent);
    const std::int64_t size = study.study().size();
    cases::CaseTable table(study.study());
    const std::filesystem::path part = mapping.folder / fmt::format("{}.part", family->name);
    if (mapping.fresh) std::filesystem::remove(part);
    table.open(part);
    table.read(part, false);
    compute(study, table, mapping.threads > 0 ? mapping.threads : cases::processors(), [&] {
      double there = done;
      for (std::int64_t k = 0; k < size; ++k) there += table.has(k);
      if (told) told(there, all, *family);
    });
    if (interruption_requested) break;
    done += static_cast<double>(size);
    maps.push_back({family, study.cells(table)});
  }
  return maps;
}

}  // namespace poinsot::stability
