# Errors of pictures against a truth that is there twice. Files: the mask; the truth at radius r by seeds
# a and b, at 2 r by a and b; then pictures, of which `rows` says "integrator,iterations,seconds ...".
# What counts are the pixels where more than half of the eye's paths end on the torus. The truth is
# extrapolated to radius zero, (4 x(r) - x(2 r)) / 3; since the noise of a and b has no part in common, the
# mean of (x - a)(x - b) is the squared error of x alone. Fails unless every photon integrator's last error
# is at most `most` times path tracing's.
BEGIN { FS = ","; n_rows = split(rows, row, " ") }
FNR == 1 { file++; pixel = 0; next }
file == 1 {
  inside[++pixel] = $3 > 0.5
  block[pixel] = int($1 / 32) + 8 * int($2 / 32)
  n += inside[pixel]
  next
}
!inside[++pixel] { next }
file <= 3 { fine[file - 2, pixel] = $3; next }
file <= 5 { truth[file - 4, pixel] = (4 * fine[file - 4, pixel] - $3) / 3; next }
{
  k = file - 5
  a = truth[0, pixel]
  b = truth[1, pixel]
  square[k] += ($3 - a) * ($3 - b) / n
  relative[k] += 4 * ($3 - a) * ($3 - b) / ((a + b) * (a + b)) / n
  if (row[k] !~ /^path/) next
  if (k != path) split("", sum) split("", sum2) split("", count)
  path = k
  d = $3 - (a + b) / 2
  sum[block[pixel]] += d
  sum2[block[pixel]] += d * d
  count[block[pixel]]++
}

function root(x) { return x > 0 ? sqrt(x) : 0 }

# What the extrapolation changed (what is left of the bias is less, where light is smooth over 2 r), rms, with two standard errors of the spread of its square over blocks.
function describe_truth(  k, a, b, mean_a, mean_b, noise, change, moved, spread) {
  for (k in inside) {
    if (!inside[k]) continue
    a = truth[0, k]
    b = truth[1, k]
    mean_a += a / n
    mean_b += b / n
    noise += (a - b) * (a - b) / n
    change[block[k]] += (fine[0, k] - a) * (fine[1, k] - b) / n
  }
  for (k in change) {
    moved += change[k]
    spread += change[k] * change[k]
  }
  mean = (mean_a + mean_b) / 2
  printf "%d pixels of the torus, mean radiance %.4f\n", n, mean
  printf "truth: standard error %.2f %% a pixel (cancels), %.2f %% of the mean; ", \
    50 * sqrt(noise) / mean, 50 * root((mean_a - mean_b) ^ 2) / mean
  printf "the extrapolation changed it by %.2f %% (95 %%: at most %.2f %%)\n", \
    100 * root(moved) / mean, 100 * root(moved + 2 * sqrt(spread)) / mean
}

# Pixels of path tracing are independent: the mean of its difference to the truth, over all of them and
# over each block of 32 x 32 with at least 256, has the standard error of its own spread.
function test_truth(  k, all, all2, m, se, z, chi2, blocks) {
  for (k in count) {
    all += sum[k]
    all2 += sum2[k]
    if (count[k] < 256) continue
    m = sum[k] / count[k]
    z = m / sqrt((sum2[k] / count[k] - m * m) / (count[k] - 1))
    chi2 += z * z
    blocks++
  }
  m = all / n
  se = sqrt((all2 / n - m * m) / (n - 1))
  printf "truth against path tracing: mean %+.2f +- %.2f %%, z = %+.1f; %d blocks, chi^2 = %.1f\n", \
    -100 * m / mean, 100 * se / mean, -m / se, blocks, chi2
}

END {
  describe_truth()
  test_truth()
  printf "  %-14s %10s %8s %10s %11s %11s %9s\n", \
    "integrator", "iterations", "CPU s", "RMSE", "RMSE/mean", "per pixel", "of path"
  for (k = 1; k <= n_rows; k++) {
    split(row[k], word, ",")
    ratio = root(square[k]) / root(square[path])
    printf "  %-14s %10d %8.1f %10.5f %10.2f%% %10.2f%% %9.4f\n", word[1], word[2], word[3], \
      root(square[k]), 100 * root(square[k]) / mean, 100 * root(relative[k]), ratio
    last[word[1]] = ratio
  }
  for (name in last) {
    if (name == "path") continue
    photons++
    good += last[name] <= most
  }
  printf "%d of %d photon integrators: error at most %g of path tracing's\n\n", good, photons, most
  exit good < photons
}
