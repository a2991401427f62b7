# Stands for a simulator: reads "name = value" lines, loads the beam in four steps, writes beam.out, steps.csv, result.json.
$2 == "=" { value[$1] = $3 }
END {
  L = value["length"]; w = value["width"]; t = value["thickness"]; E = value["modulus"]
  print "step,deflection,stress" > "steps.csv"
  for (step = 1; step <= 4; step++) {
    F = value["load"] * step / 4
    deflection = 4 * F * L^3 / (E * w * t^3)
    stress = 6 * F * L / (w * t^2)
    printf "step %d: deflection = %.17g mm\n", step, deflection > "beam.out"
    printf "%d,%.17g,%.17g\n", step, deflection, stress > "steps.csv"
  }
  printf "{\"beam\": {\"mass\": %.17g}}\n", 2.7e-3 * L * w * t > "result.json"
}
