// SPDX-License-Identifier: MIT
#pragma once

#include <IpIpoptApplication.hpp>

namespace chicane::bench {

/// Ipopt as it is compared: tolerance as ours, bounds as they are, its own defaults otherwise. `is_hot`:
/// starts from given multipliers with a barrier of 1e-5.
inline Ipopt::SmartPtr<Ipopt::IpoptApplication> make_ipopt(bool is_hot) {
  Ipopt::SmartPtr<Ipopt::IpoptApplication> app = IpoptApplicationFactory();
  app->Options()->SetIntegerValue("print_level", 0);
  app->Options()->SetStringValue("sb", "yes");
  app->Options()->SetNumericValue("tol", 1e-6);
  app->Options()->SetNumericValue("bound_relax_factor", 0.0);
  app->Options()->SetIntegerValue("max_iter", 500);
  if (is_hot) {
    app->Options()->SetStringValue("warm_start_init_point", "yes");
    app->Options()->SetNumericValue("mu_init", 1e-5);
    for (const char* push : {"warm_start_bound_push", "warm_start_bound_frac", "warm_start_slack_bound_push",
                             "warm_start_slack_bound_frac", "warm_start_mult_bound_push"}) {
      app->Options()->SetNumericValue(push, 1e-6);
    }
  }
  app->Initialize();
  return app;
}

}  // namespace chicane::bench
