"""Compares the files that the program writes with assets/schemas, and docs/outputs.md with these."""

import fnmatch
import importlib.machinery
import importlib.util
import json
import tempfile
import unittest
from pathlib import Path

import jsonschema
import shared
import vkfv

SCHEMAS = shared.SOURCE / "assets" / "schemas"


def schema(name):
    return json.loads((SCHEMAS / f"{name}.schema.json").read_text(encoding="utf-8"))


def validate(value, name):
    jsonschema.Draft202012Validator(schema(name)).validate(value)


def documented_files(kind):
    """Patterns of the files in a folder of this kind."""
    folders = json.loads((SCHEMAS / "folders.json").read_text(encoding="utf-8"))
    return [file["name"] for file in folders[kind]["files"]]


def undocumented(folder, kind):
    """The files in it that no pattern tells of."""
    files = (file.relative_to(folder).as_posix() for file in folder.rglob("*") if file.is_file())
    return [file for file in files if not any(fnmatch.fnmatchcase(file, name) for name in documented_files(kind))]


def objects(node):
    """Every object that a schema describes."""
    if isinstance(node, dict):
        if node.get("type") == "object":
            yield node
        for child in node.values():
            yield from objects(child)
    elif isinstance(node, list):
        for child in node:
            yield from objects(child)


class SchemaTest(unittest.TestCase):
    def test_schemas_are_schemas(self):
        for name in ("results", "sweep", "image", "certificate", "budget", "capability", "fit"):
            jsonschema.Draft202012Validator.check_schema(schema(name))
            for described in objects(schema(name)):
                self.assertIn("additionalProperties", described)
                if described["additionalProperties"] is False:
                    for key, value in described.get("properties", {}).items():
                        if value.get("$ref", "").startswith("#/properties/"):
                            continue  # a figure that is described there
                        if key in ("measured", "true") and described.get("description", "").startswith("A parameter"):
                            continue
                        self.assertTrue(value.get("description"), key)
                        if "number" in value.get("type", ()):
                            self.assertTrue(value.get("unit"), key)

    def test_a_key_ends_with_the_unit_that_is_declared(self):
        endings = {"um3/um2": "_um3_per_um2", "DN/e-": "_dn_per_e", "um": "_um", "%": "_percent", "deg": "_deg", "e-": "_e",
                   "DN": "_dn", "W": "_W"}
        keys = 0
        for name in ("results", "image"):
            for described in objects(schema(name)):
                for key, value in described.get("properties", {}).items():
                    ending = next((ending for ending in endings.values() if key.endswith(ending)), None)
                    if "unit" in value and (ending or value["unit"] in endings):
                        self.assertEqual(endings.get(value["unit"]), ending, key)
                        keys += 1
        self.assertGreater(keys, 50)

    def test_results(self):
        """All of the keys are met with, and no other."""
        stacks = shared.stacks()
        for stack in stacks:
            validate(stack.results, "results")
        met = set().union(*(stack.results for stack in stacks))
        self.assertEqual(set(schema("results")["properties"]) - met, {"shuffle_seed"})

    def test_an_undocumented_key_fails(self):
        for change in (
            lambda results: results.update(new=1),
            lambda results: results["curves"].update(new=1),
            lambda results: results["parameters"].update(new={"measured": 1.0}),
            lambda results: results["parameters"]["Sq_um"].update(new=1),
            lambda results: results["dimensions"][0].update(new=1),
            lambda results: results["points"].pop("dark"),
            lambda results: results.update(sq_ratio="1"),
        ):
            results = json.loads(json.dumps(shared.tilted().results))
            validate(results, "results")
            change(results)
            with self.assertRaises(jsonschema.ValidationError):
                validate(results, "results")

    def test_image(self):
        validate(shared.small_image().figures, "image")  # test_commands.py has one with a camera


    def test_certificate(self):
        """One characteristic that the instrument can measure and one that it cannot, by key."""
        with tempfile.TemporaryDirectory() as folder:
            certificate = vkfv.calibrate(shared.configuration(), out=Path(folder) / "c", only=["N_M", "slope"], small=True)
            validate(certificate.content, "certificate")
            noise = certificate.figures["N_M_at_50_percent_nm"]
            self.assertGreater(noise.value, 0)
            self.assertGreater(noise.expanded_uncertainty_95, noise.standard_uncertainty)
            self.assertNotIn("slope_limit_deg", certificate.figures)
            self.assertIn("scan is shorter", certificate.content["characteristics"][1]["remarks"][0])
            self.assertEqual(undocumented(Path(folder) / "c", "calibration"), [])

    def test_budget(self):
        """A scale that is off by 1 % makes the surface 1 % rougher."""
        with tempfile.TemporaryDirectory() as folder:
            inputs = {"stage.scale_error": {"u": 0.01, "dof": 5.0}}
            budget = vkfv.budget(shared.configuration(), "Sq", out=Path(folder) / "b", repeats=2, trials=2,
                                 stage={"scale_error": 0.0}, uncertainty=inputs)
            validate(budget.content, "budget")
            self.assertEqual(undocumented(Path(folder) / "b", "budget"), [])
            self.assertEqual(list(budget.inputs), ["stage.scale_error"])
            self.assertEqual(budget.inputs["stage.scale_error"].degrees_of_freedom, 5)
            self.assertAlmostEqual(budget.error, budget.measured - budget.truth, places=9)
            self.assertGreater(budget.expanded_uncertainty_95, budget.standard_uncertainty)
            self.assertEqual(len(budget.errors), 2)
            self.assertIn("Sq", repr(budget))

    def test_capability(self):
        """Two by two sinusoids, and the place of a tilted plane with roughness."""
        with tempfile.TemporaryDirectory() as folder:
            scan = {"z_start_um": -40.0, "z_stop_um": 40.0, "z_step_um": 8.0}
            capability = vkfv.capability(shared.configuration(), out=Path(folder) / "k", small=True, wavelengths=2,
                                         amplitudes=2, scan=scan, topography={"window_px": 3},
                                         trace={"rays": 3e4, "device": "host"}, **{"detector.pixels": [24, 20]})
            validate(capability.content, "capability")
            self.assertEqual(undocumented(Path(folder) / "k", "capability"), [])
            self.assertEqual(len(capability.nodes), 4)
            shortest, longest = capability.nodes[0], capability.nodes[-1]
            self.assertAlmostEqual(shortest.wavelength_um, 6, places=2)  # one focus window
            self.assertGreater(longest.amplitude_um, shortest.amplitude_um)
            self.assertIn("window", shortest.beyond_limits)
            self.assertGreater(capability.specimen["sq_um"], 0)
            self.assertIn("4 sinusoids", repr(capability))

    def test_fit(self):
        """How Lambertian a plane is, from a stack of few rays."""
        with tempfile.TemporaryDirectory() as folder:
            scan = {"z_start_um": -6.0, "z_stop_um": 6.0, "z_step_um": 6.0}
            stack = vkfv.run(shared.configuration(), out=Path(folder) / "s", scan=scan, **shared.SMALL)
            fit = vkfv.fit(stack.folder, ["specimen.material.g"], out=Path(folder) / "f", replicates=8)
            validate(fit.content, "fit")
            self.assertEqual(undocumented(Path(folder) / "f", "fit"), [])
            self.assertEqual(fit.parameters["specimen.material.g"].start, 0.8)
            self.assertEqual([len(row) for row in fit.covariance], [1])
            self.assertIn("specimen.material.g", repr(fit))


class FilesTest(unittest.TestCase):
    def test_every_file_is_told_of(self):
        stacks = shared.stacks()
        for stack in stacks:
            self.assertEqual(undocumented(stack.folder, "stack"), [])
        # Every documented file exists, except for those of runs that are under way.
        written = [file.relative_to(stack.folder).as_posix() for stack in stacks for file in stack.folder.rglob("*")]
        for name in documented_files("stack"):
            if name != "partial_*":
                self.assertTrue(fnmatch.filter(written, name), name)


class DocumentTest(unittest.TestCase):
    def test_outputs_md_is_that_of_the_schemas(self):
        path = str(shared.SOURCE / "tools" / "outputs_document")
        loader = importlib.machinery.SourceFileLoader("outputs_document", path)
        tool = importlib.util.module_from_spec(importlib.util.spec_from_loader("outputs_document", loader))
        loader.exec_module(tool)
        page = (shared.SOURCE / "docs" / "outputs.md").read_text(encoding="utf-8")
        self.assertEqual(page, tool.page(), "docs/outputs.md is stale. Renew it: tools/outputs_document --write")


if __name__ == "__main__":
    unittest.main()
