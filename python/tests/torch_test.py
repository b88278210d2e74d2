# SPDX-License-Identifier: MIT
"""The example of a controller as a layer of PyTorch: its gradients, and that it learns."""
import importlib.util
import sys
import unittest
from pathlib import Path

if importlib.util.find_spec("torch") is None:
    print("skipped: torch is not there: apt-get install python3-torch")
    sys.exit(77)

import torch  # noqa: E402

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "examples/python"))
import torch_layer  # noqa: E402


class Layer(unittest.TestCase):
    def test_gradients_are_those_of_differences(self):
        ocp = torch_layer.driver()
        x0 = torch.tensor([0.8, 0.2], dtype=torch.float64, requires_grad=True)
        p = torch.tensor([1.5, 0.4], dtype=torch.float64, requires_grad=True)
        self.assertTrue(torch.autograd.gradcheck(lambda x, q: torch_layer.Control.apply(ocp, x, q), (x0, p), eps=1e-5, atol=1e-5, rtol=1e-4))

    def test_weights_are_learned(self):
        weights, losses = torch_layer.learn(150)
        self.assertLess(losses[-1], 1e-2 * losses[0])
        # What the driver did does not depend on a common factor of weights but through the fixed ones.
        self.assertAlmostEqual(weights[0] / weights[1], 2.0 / 0.3, delta=0.7)


if __name__ == "__main__":
    unittest.main()
