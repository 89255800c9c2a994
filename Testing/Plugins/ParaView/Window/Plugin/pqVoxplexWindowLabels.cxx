// SPDX-FileCopyrightText: Copyright (c) The Voxplex developers
// SPDX-License-Identifier: BSD-3-Clause
/**
 * @file pqVoxplexWindowLabels.cxx
 * @brief The tests of the table of labels.
 */
#include "pqVoxplexWindowTest.h"

#include "pqActiveObjects.h"
#include "pqApplicationCore.h"
#include "pqObjectBuilder.h"
#include "pqOutputPort.h"
#include "pqPipelineSource.h"
#include "pqPropertiesPanel.h"
#include "pqServer.h"
#include "pqServerManagerModel.h"
#include "pqServerResource.h"
#include "pqUndoStack.h"

#include "vtkAlgorithm.h"
#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkFieldData.h"
#include "vtkImageData.h"
#include "vtkNew.h"
#include "vtkPVArrayInformation.h"
#include "vtkPVDataInformation.h"
#include "vtkPointData.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMSourceProxy.h"
#include "vtkXMLImageDataWriter.h"

#include <QAbstractButton>
#include <QApplication>
#include <QColor>
#include <QDockWidget>
#include <QHeaderView>
#include <QKeyEvent>
#include <QLineEdit>
#include <QMainWindow>
#include <QMouseEvent>
#include <QProcess>
#include <QStyle>
#include <QStyleOptionViewItem>
#include <QTreeView>

#include <map>

namespace
{
/** Columns of the table of labels. */
enum Columns
{
  Tick,
  Number,
  Name,
  Colour,
  Voxels,
  Size
};

/** A click or a double click inside a widget, at once. */
void clickAt(QWidget* widget, const QPoint& at, QEvent::Type press = QEvent::MouseButtonPress)
{
  for (const QEvent::Type type : { press, QEvent::MouseButtonRelease })
  {
    QMouseEvent event(type, at, widget->mapToGlobal(at), Qt::LeftButton,
      type == press ? Qt::LeftButton : Qt::NoButton, Qt::NoModifier);
    QApplication::sendEvent(widget, &event);
  }
}
QString textAt(const QTreeView* view, int row, int column)
{
  return view->model()->index(row, column).data().toString();
}
bool isTicked(const QTreeView* view, int row)
{
  return view->model()->index(row, Tick).data(Qt::CheckStateRole).toInt() == Qt::Checked;
}
/** An image of 32^3 voxels, each the label that a number of 1 to 5000 gives. */
void writeManyLabels(const QString& path)
{
  vtkNew<vtkImageData> image;
  image->SetDimensions(32, 32, 32);
  image->AllocateScalars(VTK_UNSIGNED_SHORT, 1);
  auto* const voxels = static_cast<unsigned short*>(image->GetScalarPointer());
  for (int i = 0; i < 32 * 32 * 32; ++i)
  {
    voxels[i] = static_cast<unsigned short>(1 + i % 5000);
  }
  vtkNew<vtkXMLImageDataWriter> writer;
  writer->SetFileName(path.toUtf8().data());
  writer->SetInputData(image);
  writer->Write();
}
} // namespace

//----------------------------------------------------------------------------------------------------
QTreeView* pqVoxplexWindowTest::labelTable(pqPipelineSource* source)
{
  pqActiveObjects::instance().setActiveSource(source);
  this->wait(300);
  for (QWidget* widget : this->Window->findChildren<QWidget*>("LabelTable"))
  {
    if (widget->isVisible()) // the panel keeps those of other sources
    {
      return widget->findChild<QTreeView*>("Labels");
    }
  }
  return nullptr;
}

void pqVoxplexWindowTest::search(const QTreeView* view, const QString& text)
{
  view->parent()->findChild<QLineEdit*>("SearchLabels")->setText(text);
}

QList<double> pqVoxplexWindowTest::labelRows(bool unchecked) const
{
  vtkSMPropertyHelper helper(this->Mesher->getProxy(), "LabelTable");
  helper.SetUseUnchecked(unchecked);
  QList<double> rows;
  for (unsigned int i = 0; i < helper.GetNumberOfElements(); ++i)
  {
    rows << helper.GetAsDouble(i);
  }
  return rows;
}

/** It is filled from the image, can be searched and sorted; what is changed in it reaches the mesh. */
void pqVoxplexWindowTest::testLabelTable()
{
  QTreeView* const view = this->labelTable(this->Mesher);
  this->check(view && view->model()->rowCount() == 116, "a row for each label of the atlas");
  if (view == nullptr || view->model()->rowCount() != 116)
  {
    return;
  }
  auto* const reader = vtkAlgorithm::SafeDownCast(this->Reader->getProxy()->GetClientSideObject());
  auto* const image = vtkImageData::SafeDownCast(reader->GetOutputDataObject(0));
  vtkDataArray* const voxels = image->GetPointData()->GetScalars();
  std::map<double, int> counts;
  for (vtkIdType i = 0; i < voxels->GetNumberOfTuples(); ++i)
  {
    ++counts[voxels->GetTuple1(i)];
  }
  vtkSMPropertyHelper colors(this->colorMap(), "IndexedColors");
  for (int row = 0; row < 116; ++row)
  {
    this->check(textAt(view, row, Number) == QString::number(row + 1) && isTicked(view, row) &&
        textAt(view, row, Voxels).toInt() == counts[row + 1] &&
        textAt(view, row, Size) == (row == 7 ? "3" : ""),
      "row " + QString::number(row));
    const auto color = view->model()->index(row, Colour).data(Qt::DecorationRole).value<QColor>();
    const auto at = static_cast<unsigned int>(3 * row);
    this->check(std::abs(color.redF() - colors.GetAsDouble(at)) < 0.01 &&
        std::abs(color.greenF() - colors.GetAsDouble(at + 1)) < 0.01 &&
        std::abs(color.blueF() - colors.GetAsDouble(at + 2)) < 0.01,
      "the colour of row " + QString::number(row));
  }
  this->check(textAt(view, 0, Name) == "Precentral_L", "names");
  if (auto* const dock = this->Window->findChild<QDockWidget*>("propertiesDock"))
  {
    this->Window->resizeDocks({ dock }, { 250 }, Qt::Horizontal);
    this->grab("narrow.png");
    this->check(view->header()->sectionSize(Name) >
        view->header()->fontMetrics().horizontalAdvance("Precentral_L"),
      "there is room for names in a narrow panel");
    this->Window->resizeDocks({ dock }, { 440 }, Qt::Horizontal);
    this->wait(300);
  }

  this->search(view, "precentral");
  this->check(view->model()->rowCount() == 2, "a search by name");
  this->search(view, "116");
  this->check(
    view->model()->rowCount() == 1 && textAt(view, 0, Name) == "Vermis_10", "a search by number");
  this->search(view, "");
  const auto clickHeader = [view](int column)
  {
    clickAt(
      view->header()->viewport(), QPoint(view->header()->sectionViewportPosition(column) + 20, 10));
  };
  clickHeader(Voxels);
  const int most = textAt(view, 115, Voxels).toInt();
  this->check(textAt(view, 0, Voxels).toInt() < most, "sorted by voxels");
  clickHeader(Voxels);
  this->check(textAt(view, 0, Voxels).toInt() == most, "and the other way round");
  clickHeader(Number);
  this->check(textAt(view, 0, Number) == "1" || textAt(view, 0, Number) == "116", "and by label");
  this->testLabelChanges(view);
  this->testLabelSizes(view);
  view->header()->setSortIndicator(-1, Qt::AscendingOrder);
}

/** Ticks of several selected rows: Reset, Apply, undo. */
void pqVoxplexWindowTest::testLabelChanges(QTreeView* view)
{
  auto* const panel = this->Window->findChild<pqPropertiesPanel*>();
  const QList<double> before = this->labelRows(false);
  const auto untick = [&]
  {
    this->search(view, "vermis");
    view->selectAll();
    QStyleOptionViewItem option; // where the tick is
    option.initFrom(view);
    option.features = QStyleOptionViewItem::HasCheckIndicator;
    option.rect = view->visualRect(view->model()->index(1, Tick));
    clickAt(view->viewport(),
      view->style()->subElementRect(QStyle::SE_ItemViewItemCheckIndicator, &option, view).center());
    this->check(
      !isTicked(view, 0) && !isTicked(view, 1) && !isTicked(view, 7), "all selected are unticked");
    this->search(view, "");
    this->wait(100);
    this->check(this->labelRows(true).size() == 9 * 3, "in the property, with that of label 8");
    this->check(this->labelRows(false) == before, "but not before Apply");
  };
  const auto button = [panel](const char* name)
  { return panel->findChild<QAbstractButton*>(name); };
  this->check(button("Accept") && !button("Accept")->isEnabled(), "nothing to apply");
  untick();
  this->check(button("Accept") && button("Accept")->isEnabled(), "Apply is offered");
  button("Reset")->click();
  this->wait(100);
  this->check(this->labelRows(true) == before && isTicked(view, 115), "Reset");
  untick();
  this->apply();
  this->check(this->labelRows(false).size() == 9 * 3, "Apply");
  const auto lastLabel = [this]
  {
    return this->Mesher->getOutputPort(0)
      ->getDataInformation()
      ->GetArrayInformation("Label", vtkDataObject::CELL)
      ->GetComponentRange(0)[1];
  };
  this->check(lastLabel() == 108.0, "labels without a tick are not meshed");
  this->grab("labels.png");
  pqApplicationCore::instance()->getUndoStack()->undo();
  this->wait(300);
  this->check(this->labelRows(false) == before, "undo");
  this->search(view, "vermis");
  this->check(isTicked(view, 0) && isTicked(view, 7), "in the table, too");
  this->search(view, "");
  this->apply();
  this->check(lastLabel() == 116.0, "and in the mesh");
}

void pqVoxplexWindowTest::testLabelSizes(QTreeView* view)
{
  const auto cells = [this]
  { return this->Mesher->getOutputPort(0)->getDataInformation()->GetNumberOfCells(); };
  const vtkTypeInt64 before = cells();
  this->search(view, "Frontal_Mid_R");
  const auto type = [view](const QString& text)
  {
    view->clearSelection();
    const QPoint at = view->visualRect(view->model()->index(0, Size)).center();
    clickAt(view->viewport(), at);
    clickAt(view->viewport(), at, QEvent::MouseButtonDblClick);
    auto* const editor = view->viewport()->findChild<QLineEdit*>();
    if (editor)
    {
      editor->setText(text);
      QKeyEvent enter(QEvent::KeyPress, Qt::Key_Return, Qt::NoModifier);
      QApplication::sendEvent(editor, &enter);
    }
    QApplication::processEvents();
  };
  type("1.5");
  this->check(textAt(view, 0, Size) == "1.5", "a size can be typed");
  this->check(this->labelRows(true) == QList<double>({ 8.0, 1.5, 1.0 }), "in the property");
  type("thick");
  this->check(textAt(view, 0, Size) == "1.5", "what is not a number is not taken");
  this->apply();
  this->check(cells() > before, "a smaller size gives more elements");
  type("");
  this->check(this->labelRows(true).isEmpty(), "without a size nothing is left in the property");
  this->apply();
  this->check(this->labelRows(false).isEmpty() && cells() < before, "nor in the mesh");

  this->search(view, "vermis");
  view->selectAll();
  view->model()->setData(view->model()->index(1, Size), "2", Qt::EditRole);
  this->check(textAt(view, 0, Size) == "2" && textAt(view, 7, Size) == "2" &&
      this->labelRows(true).size() == 8 * 3,
    "all selected get a size");
  view->model()->setData(view->model()->index(0, Size), "0", Qt::EditRole);
  this->check(this->labelRows(true).isEmpty(), "and lose it");
  this->search(view, "");

  // As a script would; label 500 is not in the image.
  const double rows[] = { 500.0, 0.0, 0.0, 8.0, 3.0, 1.0 };
  vtkSMPropertyHelper(this->Mesher->getProxy(), "LabelTable").Set(rows, 6);
  this->check(view->model()->rowCount() == 117, "a row for a label that the image does not have");
  this->search(view, "500");
  this->check(textAt(view, 0, Name) == "not in the image" && !isTicked(view, 0), "it says so");
  view->model()->setData(view->model()->index(0, Tick), Qt::Checked, Qt::CheckStateRole);
  this->search(view, "");
  this->apply();
  this->check(this->labelRows(false) == QList<double>({ 8.0, 3.0, 1.0 }), "it can be removed");
}

/** That of the filter for series, one of many labels, and one without labels. */
void pqVoxplexWindowTest::testOtherTables()
{
  auto* const builder = pqApplicationCore::instance()->getObjectBuilder();
  const auto read = [&](const QString& name)
  {
    const QString path = qEnvironmentVariable("VOXPLEX_TEST_OUTPUT") + "/" + name;
    return builder->createReader("sources", "XMLImageDataReader", QStringList(path),
      pqActiveObjects::instance().activeServer());
  };
  pqPipelineSource* const named = read("named.vti");
  this->apply();
  pqPipelineSource* const series = builder->createFilter("filters", "VoxplexPentatopeMesh", named);
  QTreeView* const one = this->labelTable(series);
  this->check(one && one->model()->rowCount() == 1 && textAt(one, 0, Name) == "liver" &&
      textAt(one, 0, Voxels) == "64",
    "the table of the filter for series");

  writeManyLabels(qEnvironmentVariable("VOXPLEX_TEST_OUTPUT") + "/many.vti");
  pqPipelineSource* const many = read("many.vti");
  pqPipelineSource* const mesher = builder->createFilter("filters", "VoxplexTetMesh", many);
  QTreeView* const view = this->labelTable(mesher);
  this->check(view && view->model()->rowCount() == 0, "no rows before the image is read");
  many->updatePipeline();
  this->check(view && view->model()->rowCount() == 5000, "5000 rows");
  if (view)
  {
    this->search(view, "4999");
    this->check(textAt(view, 0, Voxels) == "6", "voxels of one of them");
    vtkSMPropertyHelper(mesher->getProxy(), "InputMode").Set(1);
    this->wait(100);
    this->check(view->model()->rowCount() == 0, "grey values have no labels");
  }
  for (pqPipelineSource* source : { mesher, many, series, named })
  {
    builder->destroy(source);
  }
  pqActiveObjects::instance().setActiveSource(this->Mesher);
  this->wait(300);
}

/** The table comes from the server, which alone has the image. */
void pqVoxplexWindowTest::testServer()
{
  QProcess server;
  server.setProcessChannelMode(QProcess::MergedChannels);
  int port = 11420;
  for (bool accepts = false; !accepts && port < 11440; port += accepts ? 0 : 1)
  {
    server.start(
      qEnvironmentVariable("VOXPLEX_TEST_PVSERVER"), { QString("--server-port=%1").arg(port) });
    QByteArray output;
    while (!accepts && server.waitForReadyRead(60000))
    {
      output += server.readAll();
      accepts = output.contains("Accepting connection");
    }
  }
  auto* const builder = pqApplicationCore::instance()->getObjectBuilder();
  pqServer* const connection =
    builder->createServer(pqServerResource(QString("cs://localhost:%1").arg(port)));
  this->check(connection && connection->isRemote(), "a connection to a server");
  if (connection && connection->isRemote())
  {
    pqPipelineSource* const reader = builder->createReader("sources", "VoxplexSegmentationReader",
      QStringList(qEnvironmentVariable("VOXPLEX_TEST_ATLAS")), connection);
    this->apply();
    this->Mesher = builder->createFilter("filters", "VoxplexTetMesh", reader);
    QTreeView* const view = this->labelTable(this->Mesher);
    this->check(this->Mesher->getProxy()->GetClientSideObject() == nullptr, "the filter is there");
    this->check(view && view->model()->rowCount() == 116, "all labels come from the server");
    this->check(
      view && textAt(view, 115, Name) == "Vermis_10" && textAt(view, 115, Voxels).toInt() > 0,
      "with their names and voxels");
    this->check(
      view && view->model()->index(0, Colour).data(Qt::DecorationRole).value<QColor>().isValid(),
      "and colours");
    this->grab("server.png");
  }
  server.terminate();
  server.waitForFinished(30000);
}
