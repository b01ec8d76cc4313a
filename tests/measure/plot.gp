# Draws a table of lines, to TABLE.svg and TABLE.png:   gnuplot -c tests/measure/plot.gp TABLE.tsv TITLE
#
# Columns: panel, line, x, y, colour. The names of the third and fourth label the axes, which are logarithmic.
table = ARG1
path = table[1:strlen(table) - 4]
awk(program) = system("awk -F'\\t' '".program."' '".table."'")
panels = awk("NR > 1 && !seen[$1]++ { printf \"\\\"%s\\\" \", $1 }")
lines = awk("NR > 1 && !seen[$2]++ { printf \"\\\"%s\\\" \", $2 }")
colours = awk("NR > 1 && !seen[$2]++ { printf \"%s \", $5 }")
columns = words(panels) < 3 ? words(panels) : 3
rows = (words(panels) + columns - 1) / columns
set datafile separator tab
set encoding utf8
do for [kind in "svg png"] {
    terminal = kind eq "svg" ? "svg" : "pngcairo"
    set terminal @terminal noenhanced font "DejaVu Sans,13" background "#ffffff" size 820 * columns, 460 * rows + 60
    set output path.".".kind
    set multiplot layout rows, columns title ARG2 font ",17"
    set logscale xy
    set format xy "1e%T"
    set grid lt 1 lc rgb "#dddddd"
    set key outside right top
    set xlabel awk("NR == 1 { print $3 }")
    set ylabel awk("NR == 1 { print $4 }")
    do for [p = 1:words(panels)] {
        set title word(panels, p)
        plot for [i = 1:words(lines)] table \
            using (strcol(1) eq word(panels, p) && strcol(2) eq word(lines, i) ? $3 : NaN):4 \
            with linespoints lw 2 pt 7 ps 0.5 lc rgb word(colours, i) title word(lines, i)
    }
    unset multiplot
    unset output
}
