# The header, then a line of the row's number, length (mm), thickness (mm), load (N) for each row.
read -r header
while IFS=, read -r id length thickness load
do
  awk -v id="$id" -v L="$length" -v t="$thickness" -v F="$load" 'BEGIN {
    w = 10; E = 70e3    # mm, MPa
    printf "%s,%.17g,%.17g\n", id, 4 * F * L^3 / (E * w * t^3), 6 * F * L / (w * t^2)
  }'
done
