# The functions of a C++ file, as text: to replace those of one file by those of another.
use strict;
use warnings;

my $string = qr/"(?:[^"\\]|\\.)*"|(?<!\w)'(?:[^'\\]|\\.)*'/s;
my $comment = qr{//[^\n]*|/\*.*?\*/}s;
my ($round, $curly);
$round = qr/\((?:$comment|$string|[^()"]|(??{$round}))*?\)/s;
$curly = qr/\{(?:$comment|$string|[^{}"]|(??{$curly}))*?\}/s;

# A file in parts, in the order in which they stand: [text, name]. The name is that of a function or type;
# the second function of a name is "name 2". All else has none, nor has what is only declared.
sub parts_of_file {
    my ($text) = @_;
    my (@parts, %count);
    pos($text) = 0;
    while (pos($text) < length $text) {
        if ($text =~ /\G(?:\s+|$comment|\#(?:[^\n\\]|\\.)*|(?:inline\s+)?namespace\b[^{;]*\{|(?:public|private):|[};])/gcs) {
            push @parts, [$&];
            next;
        }
        $text =~ /\G(?:$comment|$string|$round|operator\W+(?=\()|[=!<>]=|[^(){};="])*/gcs;
        my ($head, $name) = ($&);
        if ($head =~ /^(?:template\s*<[^;]*?>\s*)?(?:struct|class|union|enum(?:\s+class)?)\s+(\w+)[^(]*$/s) {
            $name = $1;
            $text =~ /\G$curly?[^;]*;/gcs and $head .= $&;
        } elsif ($head =~ /(\w+|operator\W+)\s*\(/ && $text =~ /\G$curly/gcs) {
            ($head, $name) = ("$head$&", $head =~ /(\w+|operator[^\w\s]+)\s*\(/);
        } elsif ($text =~ /\G(?:$comment|$string|$round|$curly|[^;])*?(?:;|\z)/gcs) {
            $head .= $&;
        }
        last if $head eq '';
        my $n = defined $name ? ++$count{$name} : 0;
        push @parts, [$head, $n > 1 ? "$name $n" : $name];
    }
    push @parts, [substr($text, pos($text) // 0)];
    return @parts;
}

# Whether two texts are the same code.
sub same_code {
    my ($a, $b) = map { s/($string)|$comment|\s+/$1 \/\/ ''/gesr } @_;
    return $a eq $b;
}

# The text of `base` with the functions and types of these names from `donor`, and before them what only `donor` has.
sub with_parts {
    my ($base, $donor, @names) = @_;
    my %from = map { defined $_->[1] ? ($_->[1] => $_->[0]) : () } @$donor;
    my %has = map { ($_->[1] // '') => 1 } @$base;
    my $added = join '', map { "$_->[0]\n" } grep { defined $_->[1] && !$has{$_->[1]} } @$donor;
    my ($text, %wanted) = ('', map { $_ => 1 } @names);
    for (@$base) {
        my ($own, $name) = @$_;
        if (defined $name && $wanted{$name}) {
            ($own, $added) = ($added . $from{$name}, '');
        }
        $text .= $own;
    }
    return $text;
}
1;
