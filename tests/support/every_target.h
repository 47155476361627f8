#pragma once
#include <gtest/gtest.h>

#include <hwy/targets.h>

namespace voxlume::test {

/// Runs `body` once for every instruction set that this machine and this build have.
template <class Body>
void for_every_target(Body&& body) {
  for (const auto target : hwy::SupportedAndGeneratedTargets()) {
    SCOPED_TRACE(hwy::TargetName(target));
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    body();
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().DeInit();
  }
}

}  // namespace voxlume::test
