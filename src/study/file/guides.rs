//! What stands in a study whose model is the user's own, as `apportion models` tells it.

use crate::model::Expression;

/// Formulas.
pub(super) fn expression() -> String {
    format!(
        "  model = \"expression\"\n\n  [expression]\n  outputs.y = \"sin(x1) + a*sin(x2)^2 + b*x3^4*sin(x1)\"\n  \
         outputs.k = {{ formula = \"x1/x2\", unit = \"N/m\" }}\n  constants.a = 7\n  constants.b = \"0.1 um\"\n\n\
         Factors are those of the study. Formulas have all values in SI units, and give theirs in SI units.\n\
         Operators: + - * / ^, and < <= > >= == != (1 if it holds, else 0); -x^2 is -(x^2), 2^3^2 is 2^9.\n\
         Names of NumPy and of Python's math are understood: np.sin(x), math.pi, np.where(condition, x, y).\n\
         Functions and numbers: {}\n",
        Expression::vocabulary().join(", ")
    )
}

/// A model that runs outside.
pub(super) fn external() -> String {
    "  model = \"external\"\n\n  [external]\n  outputs.force = \"nN\"\n  outputs.ratio = \"1\"\n\n\
         Factors are those of the study, with names and units of its own. The three steps:\n\n  \
         apportion sample STUDY.toml -o design.csv\n  (the model computes its outputs, row by row, into outputs.csv)\n  \
         apportion analyze outputs.csv --design design.csv\n\nFiles are CSV or NPY, by their ending.\n"
        .to_owned()
}

/// A program.
pub(super) fn command() -> String {
    "  model = \"command\"\n  outputs = [\"y\"]\n  [command]\n  \
         program = [\"python3\", \"my_model.py\"]    # relative to the study; no shell reads it\n\n\
         The program is kept alive. It reads the names of the columns and then a line for each row, its number \
         and the values in the\nunits of the study, and prints a line for each, the number and the outputs, at once:\n\n  \
         import csv, sys\n  for row in csv.DictReader(sys.stdin):\n      number = row.pop(\"id\")\n      \
         x = {name: float(value) for name, value in row.items()}\n      \
         print(number, x[\"x1\"] * x[\"x2\"], sep=\",\", flush=True)\n\nor \"error: \" and a reason behind the number where there is no \
         answer. With units and choices:\n\n  \
         [command]\n  program = [\"python3\", \"my_model.py\"]\n  outputs.force = \"nN\"\n  outputs.time = \"s\"\n  \
         protocol = \"json-lines\"      # an object for each row in, and one out [csv]\n  \
         workers = 4                  # processes at once [one for each core]\n  \
         timeout = \"60 s\"             # for a row [none]\n  \
         retries = 1                  # of a row on which the program died, hung or printed rubbish\n  \
         directory = \"model\"          # where it runs [the folder of the study]\n  \
         depends_on = [\"mesh.dat\"]    # files that decide its answers, beside those in `program`\n  \
         env.OMP_NUM_THREADS = \"1\"\n\nA program that reads an input file runs once for each row, in a directory of its own:\n\n  \
         [command]\n  program = [\"simulator\", \"beam.in\"]\n  \
         template = \"beam.in\"         # text in which {{name}} stands for a factor\n  \
         input = \"beam.in\"            # its name in the directory of a run\n  \
         files = [\"mesh.dat\"]         # copied there\n  \
         keep = \"runs\"                # where these directories stay [they are removed]\n  \
         outputs.force = { file = \"beam.out\", regex = 'force = (\\S+)', unit = \"nN\" }\n  \
         outputs.time = { file = \"history.csv\", column = \"t\", match = \"last\" }\n  \
         outputs.mass = { file = \"result.json\", pointer = \"/beam/mass\" }\n\n\
         A program that draws random numbers gets a seed with every row, like a factor, by a line above the first table\n\
         (docs/stochastic-models.md):\n\n  noise = \"seed\"\n\n\
         docs/worker-protocol.md has it in full, with what happens when a program dies, hangs, or prints rubbish.\n"
        .to_owned()
}
